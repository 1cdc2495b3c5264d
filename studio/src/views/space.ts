// Space by three.js: lines as wide as on paper, dots, surfaces as triangles whose points, normals and colours the module
// computed. A picture is drawn only when something changed. Left: turn; Shift or middle: move; wheel: zoom to the cursor;
// 1, 3, 7, 0: front, side, top, oblique; 5: parallel or perspective; F or Home: all of it.

import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import { calm, coalesced, h, s } from "../ui/dom";
import { onTheme } from "../ui/theme";
import { Handles } from "./handles";
import { disc, discard, material, paint, type SurfaceStyle } from "./materials";
import { box, distanceFor, local, type Point, type Run, type Style, type View } from "./view";

export type { Look, SurfaceStyle } from "./materials";

export interface Triangles {
    readonly points: Float32Array;
    readonly normals?: Float32Array | undefined;
    readonly indices: Uint32Array;
    /** Red, green, blue of each point, 0 to 1. */
    readonly colours?: Float32Array | undefined;
    /** What all points are relative to. */
    readonly origin?: readonly [number, number, number] | undefined;
}

/** Milliseconds without a movement after which all triangles are drawn again. */
const kStill = 250;
/** Pixels that are kept free around everything. */
const kMargin = 12;

export class Space implements View {
    readonly element: HTMLElement;
    readonly handles: Handles;
    readonly redraw = coalesced(() => { this.render(); });
    readonly scene = new THREE.Scene();
    camera: THREE.PerspectiveCamera | THREE.OrthographicCamera;
    private readonly eye = new THREE.PerspectiveCamera(32, 1.5, 0.01, 1000);
    private readonly flat = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.01, 1000);
    private readonly renderer: THREE.WebGLRenderer;
    private readonly controls: OrbitControls;
    readonly overlay = s("svg", { class: "overlay" });
    private readonly labels = s("g");
    private readonly picture = new THREE.Group();
    /** Surfaces, which take longest to make. */
    private readonly sheets = new THREE.Group();
    private texts: { at: Point; text: string; colour: string }[] = [];
    private readonly lines = new Set<LineMaterial>();
    private wanted: { lower: number[]; upper: number[] } | undefined;
    private readonly watcher: ResizeObserver;
    private readonly forget: () => void;
    private readonly ray = new THREE.Raycaster();
    /** What is drawn while the eye moves, in place of what is looked at. */
    private readonly levels: { readonly fine: THREE.Object3D; readonly coarse: THREE.Object3D }[] = [];
    private still: ReturnType<typeof setTimeout> | undefined;
    /** The theme changed: what was drawn has the colours of the old one. */
    onColours: (() => void) | undefined;
    onMoved: (() => void) | undefined;
    /** A picture was drawn: what stands over it follows. */
    onDrawn: (() => void) | undefined;

    constructor(label: string) {
        this.camera = this.eye;
        this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
        this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
        const canvas = this.renderer.domElement;
        canvas.tabIndex = 0;
        canvas.setAttribute("role", "application");
        canvas.setAttribute("aria-label", label);
        this.element = h("div", { class: "view space" }, canvas, this.overlay);
        this.handles = new Handles(this, this.overlay);
        this.overlay.append(this.labels, this.handles.layer);
        this.eye.up.set(0, 0, 1);
        this.flat.up.set(0, 0, 1);
        this.eye.position.set(4, -6, 4);
        this.scene.add(this.picture, this.sheets, new THREE.HemisphereLight(0xffffff, 0x8a8f99, 1.6));
        const lamp = new THREE.DirectionalLight(0xffffff, 1.9);
        lamp.position.set(0.6, 1.2, 1.5);
        this.eye.add(lamp);
        const second = lamp.clone();
        this.flat.add(second);
        this.scene.add(this.eye, this.flat);
        this.controls = new OrbitControls(this.eye, canvas);
        this.controls.enableDamping = false;
        this.controls.zoomToCursor = true;
        this.controls.addEventListener("change", () => { this.moved(); this.redraw(); this.onMoved?.(); });
        canvas.addEventListener("keydown", (event) => { this.key(event); });
        this.watcher = new ResizeObserver(() => { this.measure(); });
        this.watcher.observe(this.element);
        this.forget = onTheme(() => { this.onColours?.(); this.redraw(); });
    }

    dispose(): void {
        this.clear();
        clearTimeout(this.still);
        this.watcher.disconnect();
        this.forget();
        this.controls.dispose();
        this.renderer.dispose();
        this.renderer.forceContextLoss();
    }

    clear(): void {
        this.empty(this.sheets);
        this.levels.length = 0;
        this.clearLines();
    }

    /** What is drawn next stands with the surfaces that are there. */
    clearLines(): void {
        this.empty(this.picture);
        this.lines.clear();
        this.texts = [];
        this.redraw();
    }

    private empty(group: THREE.Group): void {
        for (const child of [...group.children]) discard(child);
        group.clear();
    }

    /** Takes one object out of the picture. */
    remove(object: THREE.Object3D): void {
        discard(object);
        object.removeFromParent();
        this.redraw();
    }

    /** Shows `coarse` instead of `fine` while the eye moves. */
    stands(coarse: THREE.Object3D, fine: THREE.Object3D): void {
        coarse.visible = false;
        this.levels.push({ fine, coarse });
    }

    private moved(): void {
        if (this.levels.length === 0) return;
        clearTimeout(this.still);
        this.coarsely(true);
        this.still = setTimeout(() => { this.coarsely(false); }, kStill);
    }

    private coarsely(on: boolean): void {
        for (const { fine, coarse } of this.levels) {
            fine.visible = !on;
            coarse.visible = on;
        }
        this.element.dataset["level"] = on ? "coarse" : "fine";
        this.redraw();
    }

    line(run: Run, style: Style): void {
        const ends: number[] = [];
        const n = Math.floor(run.at.length / run.dimension);
        for (let i = 0; i + 1 < n; ++i) {
            const a = this.corner(run, i), b = this.corner(run, i + 1);
            if ([...a, ...b].every(Number.isFinite)) ends.push(...a, ...b);
        }
        this.segments(ends, style);
    }

    /** Many lines as one object, points after each other: a model has thousands. */
    runs(all: readonly Float64Array[], style: Style): THREE.Object3D | undefined {
        const ends: number[] = [];
        for (const line of all) for (let k = 3; k < line.length; k += 3) ends.push(...line.subarray(k - 3, k + 3));
        return this.segments(ends, style);
    }

    /** Segments between pairs of points, three numbers each. */
    segments(ends: ArrayLike<number>, style: Style): THREE.Object3D | undefined {
        if (ends.length === 0) return undefined;
        const { origin, places } = local(ends), geometry = new LineSegmentsGeometry().setPositions(places);
        const look = new LineMaterial({ color: paint(style.colour), linewidth: style.width ?? 2, transparent: style.opacity !== undefined,
            opacity: style.opacity ?? 1, dashed: style.dashed ?? false, dashSize: 0.06, gapSize: 0.05 });
        look.resolution.set(this.element.clientWidth || 600, this.element.clientHeight || 400);
        this.lines.add(look);
        const object = new LineSegments2(geometry, look);
        object.position.set(...origin);
        if (style.dashed) object.computeLineDistances();
        this.add(object);
        return object;
    }

    dots(run: Run, style: Style): void {
        const n = Math.floor(run.at.length / run.dimension);
        const all = new Float64Array(3 * n);
        for (let i = 0; i < n; ++i) all.set(this.corner(run, i), 3 * i);
        const { origin, places } = local(all);
        const geometry = new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(places, 3));
        const object = new THREE.Points(geometry, new THREE.PointsMaterial({ color: paint(style.colour), size: style.width ?? 7,
            sizeAttenuation: false, map: disc(), alphaTest: 0.5, transparent: true }));
        object.position.set(...origin);
        this.add(object);
    }

    surface(triangles: Triangles, style: SurfaceStyle = {}): THREE.Mesh {
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute("position", new THREE.BufferAttribute(triangles.points, 3));
        geometry.setIndex(new THREE.BufferAttribute(triangles.indices, 1));
        if (triangles.normals) geometry.setAttribute("normal", new THREE.BufferAttribute(triangles.normals, 3));
        else geometry.computeVertexNormals();
        if (triangles.colours) geometry.setAttribute("color", new THREE.BufferAttribute(triangles.colours, 3));
        const mesh = new THREE.Mesh(geometry, material(style, triangles.colours !== undefined));
        mesh.position.set(...(triangles.origin ?? [0, 0, 0]));
        this.add(mesh, this.sheets);
        if (style.edges) {
            const wire = new THREE.LineSegments(new THREE.WireframeGeometry(geometry),
                new THREE.LineBasicMaterial({ color: paint("ink"), transparent: true, opacity: 0.35 }));
            wire.position.copy(mesh.position);
            this.add(wire, this.sheets);
        }
        mesh.updateMatrixWorld();
        return mesh;
    }

    label(at: Point, text: string, colour = "ink-soft"): void {
        this.texts.push({ at, text, colour });
        this.redraw();
    }

    fit(points: readonly Point[]): void {
        this.wanted = box(points);
        this.frame();
    }

    /** Looks along a direction at everything. */
    look(x: number, y: number, z: number): void {
        const away = new THREE.Vector3(x, y, z).normalize();
        const distance = this.camera.position.distanceTo(this.controls.target);
        this.camera.position.copy(this.controls.target).addScaledVector(away, distance);
        this.controls.update();
        this.redraw();
    }

    project(p: Point): readonly [number, number] {
        const v = new THREE.Vector3(p[0] ?? 0, p[1] ?? 0, p[2] ?? 0).project(this.camera);
        if (v.z > 1 || v.z < -1) return [NaN, NaN];
        return [((v.x + 1) / 2) * this.element.clientWidth, ((1 - v.y) / 2) * this.element.clientHeight];
    }

    unproject(x: number, y: number, like: Point): number[] {
        const depth = new THREE.Vector3(like[0] ?? 0, like[1] ?? 0, like[2] ?? 0).project(this.camera).z;
        const v = new THREE.Vector3((x / this.element.clientWidth) * 2 - 1, 1 - (y / this.element.clientHeight) * 2, depth);
        v.unproject(this.camera);
        return like.length === 2 ? [v.x, v.y] : [v.x, v.y, v.z];
    }

    /** The line of sight through a pixel. */
    sight(x: number, y: number): { from: [number, number, number]; along: [number, number, number] } {
        const at = new THREE.Vector2((x / this.element.clientWidth) * 2 - 1, 1 - (y / this.element.clientHeight) * 2);
        this.ray.setFromCamera(at, this.camera);
        return { from: this.ray.ray.origin.toArray(), along: this.ray.ray.direction.toArray() };
    }

    /** The triangle of `mesh` under a pixel: where the ray meets it, and its number. */
    pick(x: number, y: number, mesh: THREE.Object3D): { point: number[]; triangle: number } | undefined {
        this.sight(x, y);
        const hit = this.ray.intersectObject(mesh, false)[0];
        return hit ? { point: hit.point.toArray(), triangle: hit.faceIndex ?? 0 } : undefined;
    }

    /** A picture of it as PNG, as a data URL. */
    png(): string {
        this.render();
        return this.renderer.domElement.toDataURL("image/png");
    }

    get canvas(): HTMLCanvasElement { return this.renderer.domElement; }

    private corner(run: Run, i: number): [number, number, number] {
        const d = run.dimension, k = i * d;
        return [run.at[k] ?? 0, run.at[k + 1] ?? 0, d > 2 ? run.at[k + 2] ?? 0 : 0];
    }

    private add(object: THREE.Object3D, to = this.picture): void {
        to.add(object);
        this.redraw();
    }

    private measure(): void {
        const { clientWidth: width, clientHeight: height } = this.element;
        if (width === 0 || height === 0) return;
        this.renderer.setSize(width, height, false);
        this.eye.aspect = width / height;
        this.eye.updateProjectionMatrix();
        for (const line of this.lines) line.resolution.set(width, height);
        if (this.wanted) this.frame();
        else this.redraw();
    }

    /** Everything in the picture, seen from where the eye is, whatever its size. */
    frame(): void {
        if (!this.wanted) return;
        const lower = new THREE.Vector3().fromArray([...this.wanted.lower, 0].slice(0, 3));
        const upper = new THREE.Vector3().fromArray([...this.wanted.upper, 0].slice(0, 3));
        const centre = lower.clone().add(upper).multiplyScalar(0.5);
        const radius = Math.max(upper.distanceTo(lower) / 2, 1e-9);
        const away = this.camera.position.clone().sub(this.controls.target);
        if (!(away.length() > 0)) away.set(4, -6, 4);
        const narrow = Math.min(1, this.element.clientWidth / Math.max(1, this.element.clientHeight));
        const distance = radius / Math.sin((this.eye.fov * Math.PI) / 360) / narrow;
        this.controls.target.copy(centre);
        away.normalize();
        // Much of the ball around a box is empty, as a rule; but no corner is cut off.
        const { clientWidth, clientHeight } = this.element, tall = Math.tan((this.eye.fov * Math.PI) / 360);
        const right = this.camera.up.clone().cross(away), up = away.clone().cross(right.length() > 0 ? right.normalize() : right.set(1, 0, 0));
        const free = Math.max(0.5, 1 - (2 * kMargin) / Math.max(1, Math.min(clientWidth, clientHeight)));
        const slopes = [free * tall * (clientWidth / Math.max(1, clientHeight)), free * tall] as const;
        const needed = distanceFor(upper.clone().sub(lower).toArray(), away.toArray(), up.toArray(), slopes);
        this.camera.position.copy(centre).addScaledVector(away, Math.max(distance * 0.9, needed));
        this.eye.near = distance / 200;
        this.eye.far = distance * 20;
        this.eye.updateProjectionMatrix();
        this.flat.near = -distance * 10;
        this.flat.far = distance * 20;
        this.flat.zoom = 1;
        this.controls.update();
        this.redraw();
    }

    /** Does what a key asks for. */
    key(event: KeyboardEvent): void {
        const turn = calm() ? 0.2 : 0.12;
        const keys: Record<string, () => void> = {
            "1": () => { this.look(0, -1, 0); }, "3": () => { this.look(1, 0, 0); }, "7": () => { this.look(0, -1e-3, 1); }, "0": () => { this.look(4, -6, 4); },
            "5": () => { this.project5(); }, f: () => { this.frame(); }, ".": () => { this.frame(); }, Home: () => { this.frame(); },
            ArrowLeft: () => { this.turn(turn, 0); }, ArrowRight: () => { this.turn(-turn, 0); },
            ArrowUp: () => { this.turn(0, -turn); }, ArrowDown: () => { this.turn(0, turn); },
            "+": () => { this.dolly(0.85); }, "-": () => { this.dolly(1.18); },
        };
        const act = event.ctrlKey || event.metaKey || event.altKey ? undefined : keys[event.key === "F" ? "f" : event.key];
        if (!act) return;
        event.preventDefault();
        event.stopPropagation();
        act();
    }

    private turn(round: number, over: number): void {
        const away = this.camera.position.clone().sub(this.controls.target);
        const spherical = new THREE.Spherical().setFromVector3(new THREE.Vector3(away.x, away.z, -away.y));
        spherical.theta += round;
        spherical.phi = Math.min(Math.PI - 0.01, Math.max(0.01, spherical.phi + over));
        const v = new THREE.Vector3().setFromSpherical(spherical);
        this.camera.position.copy(this.controls.target).add(new THREE.Vector3(v.x, -v.z, v.y));
        this.controls.update();
        this.redraw();
    }

    private dolly(factor: number): void {
        this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
        this.controls.update();
        this.redraw();
    }

    /** Between perspective and parallel projection. */
    project5(): void {
        const next = this.camera === this.eye ? this.flat : this.eye;
        next.position.copy(this.camera.position);
        next.quaternion.copy(this.camera.quaternion);
        this.camera = next;
        this.controls.object = next;
        this.controls.update();
        this.redraw();
    }

    private render(): void {
        if (this.element.clientWidth === 0) return;
        if (this.camera === this.flat) {
            const half = this.camera.position.distanceTo(this.controls.target) * Math.tan((this.eye.fov * Math.PI) / 360);
            Object.assign(this.flat, { left: -half * this.eye.aspect, right: half * this.eye.aspect, top: half, bottom: -half });
            this.flat.updateProjectionMatrix();
        }
        this.camera.updateMatrixWorld();
        this.renderer.render(this.scene, this.camera);
        this.labels.replaceChildren(...this.texts.map(({ at, text, colour }) => {
            const [x, y] = this.project(at);
            return s("text", { x: (x + 8).toFixed(1), y: (y - 8).toFixed(1), fill: `var(--${colour})`, class: "label" }, text);
        }));
        this.handles.place();
        this.onDrawn?.();
    }
}
