// The plane as SVG: grid, curves, dots, areas, labels. Dragging the ground moves it, the wheel or two fingers zoom.

import { coalesced, h, s, set, shown } from "../ui/dom";
import { Handles } from "./handles";
import { box, round125, type Point, type Run, type Style, type View } from "./view";

export interface PlaneOptions {
    readonly label: string;
    /** Graphs: x and y have scales of their own. */
    readonly graph?: boolean;
    readonly grid?: boolean;
    /** The ground can be dragged and zoomed. */
    readonly movable?: boolean;
    readonly height?: number;
    /** Pixels that are kept free above and below what is shown. */
    readonly above?: number;
}

type Item =
    | { readonly kind: "line" | "dots"; readonly run: Run; readonly style: Style }
    | { readonly kind: "image"; readonly url: string; readonly lower: Point; readonly upper: Point }
    | { readonly kind: "label"; readonly at: Point; readonly text: string; readonly colour: string };

const paint = (name: string): string => (/^[#a-z]+(\(|$)/.test(name) && name.startsWith("#") || name.includes("(") ? name : `var(--${name})`);
const px = (x: number): string => (Math.abs(x) < 1e6 ? x.toFixed(2) : x > 0 ? "1e6" : "-1e6");

export class Plane implements View {
    readonly element: HTMLElement;
    readonly handles: Handles;
    private readonly svg: SVGSVGElement;
    private readonly ground = s("g", { class: "grid" });
    private readonly picture = s("g", { class: "picture" });
    private items: Item[] = [];
    private readonly drawings = new Map<string, string>();
    private width = 600;
    private height = 400;
    private scale: [number, number] = [50, 50];
    private origin: [number, number] = [300, 200];
    private wanted: { lower: number[]; upper: number[] } | undefined;
    private readonly redraw = coalesced(() => { this.show(); });
    private readonly watcher: ResizeObserver;
    private readonly fingers = new Map<number, [number, number]>();
    /** A click on the ground that moved nothing. */
    onGround: ((at: number[], event: PointerEvent) => void) | undefined;
    /** Drags of the ground with this return value `true` are someone else's (a selection frame). */
    onGroundDrag: ((event: PointerEvent) => boolean) | undefined;

    constructor(private readonly options: PlaneOptions) {
        this.svg = s("svg", { class: "plane", role: "group", "aria-label": options.label });
        this.handles = new Handles(this, this.svg);
        this.svg.append(this.ground, this.picture, this.handles.layer);
        this.element = h("div", { class: `view${options.graph ? " graph" : ""}`,
            style: options.height ? `height:${options.height}px;min-height:0;flex:none` : null }, this.svg);
        this.watcher = new ResizeObserver(() => { this.measure(); });
        this.watcher.observe(this.element);
        if (options.movable !== false) this.listen();
    }

    dispose(): void {
        this.watcher.disconnect();
        for (const url of this.drawings.values()) URL.revokeObjectURL(url);
    }

    clear(): void {
        for (const [svg, url] of [...this.drawings].slice(0, -2)) {
            URL.revokeObjectURL(url);
            this.drawings.delete(svg);
        }
        this.items = [];
        this.redraw();
    }

    line(run: Run, style: Style): void {
        this.items.push({ kind: "line", run, style });
        this.redraw();
    }

    dots(run: Run, style: Style): void {
        this.items.push({ kind: "dots", run, style });
        this.redraw();
    }

    label(at: Point, text: string, colour = "ink-soft"): void {
        this.items.push({ kind: "label", at, text, colour });
        this.redraw();
    }

    /** A drawing (SVG text) that fills the box between two corners. */
    image(svg: string, lower: Point, upper: Point): void {
        // One address for one drawing: what is shown already is not decoded again.
        const url = this.drawings.get(svg) ?? URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
        this.drawings.set(svg, url);
        this.items.push({ kind: "image", url, lower, upper });
        this.redraw();
    }

    fit(points: readonly Point[]): void {
        this.wanted = box(points);
        this.frame();
    }

    project(p: Point): readonly [number, number] {
        return [this.origin[0] + (p[0] ?? 0) * this.scale[0], this.origin[1] - (p[1] ?? 0) * this.scale[1]];
    }

    unproject(x: number, y: number, like: Point): number[] {
        return [(x - this.origin[0]) / this.scale[0], (this.origin[1] - y) / this.scale[1], ...like.slice(2)];
    }

    /** Model units per pixel. */
    get unit(): number { return 1 / this.scale[0]; }

    /** What is seen now: lower left and upper right corner. */
    get window(): { lower: number[]; upper: number[] } {
        return { lower: this.unproject(0, this.height, []), upper: this.unproject(this.width, 0, []) };
    }

    /** The picture as a file of its own: colours as they are on the screen. */
    picturesque(): string {
        const copy = this.svg.cloneNode(true) as SVGSVGElement;
        copy.querySelector(".handles")?.remove();
        set(copy, "xmlns", "http://www.w3.org/2000/svg");
        set(copy, "viewBox", `0 0 ${this.width} ${this.height}`);
        const look = getComputedStyle(document.documentElement);
        return copy.outerHTML.replace(/var\((--[a-z0-9-]+)\)/g, (_, name: string) => look.getPropertyValue(name).trim());
    }

    private measure(): void {
        const { clientWidth, clientHeight } = this.element;
        if (clientWidth === 0 || clientHeight === 0) return;
        const shift = [clientWidth - this.width, clientHeight - this.height] as const;
        this.width = clientWidth;
        this.height = clientHeight;
        if (this.wanted) this.frame();
        else {
            this.origin = [this.origin[0] + shift[0] / 2, this.origin[1] + shift[1] / 2];
            this.show();
        }
    }

    private frame(): void {
        if (!this.wanted) return;
        const { lower, upper } = this.wanted;
        const [x0 = 0, y0 = 0] = lower, [x1 = 1, y1 = 1] = upper;
        const margin = this.options.graph ? 34 : 48;
        const above = this.options.above ?? margin;
        const sx = (this.width - 2 * margin) / (x1 - x0 || 1), sy = (this.height - 2 * above) / (y1 - y0 || 1);
        const both = Math.max(1e-12, Math.min(sx, sy));
        this.scale = this.options.graph ? [Math.max(sx, 1e-12), Math.max(sy, 1e-12)] : [both, both];
        this.origin = [this.width / 2 - ((x0 + x1) / 2) * this.scale[0], this.height / 2 + ((y0 + y1) / 2) * this.scale[1]];
        this.show();
    }

    private show(): void {
        if (this.options.grid !== false) this.grid();
        this.picture.replaceChildren(...this.items.flatMap((item) => this.render(item)));
        this.handles.place();
    }

    private render(item: Item): SVGElement[] {
        if (item.kind === "label") {
            const [x, y] = this.project(item.at);
            return [s("text", { x: px(x + 8), y: px(y - 8), fill: paint(item.colour), class: "label" }, item.text)];
        }
        if (item.kind === "image") {
            const [x0, y1] = this.project(item.lower), [x1, y0] = this.project(item.upper);
            return [s("image", { href: item.url, x: px(x0), y: px(y0), width: px(x1 - x0), height: px(y1 - y0), preserveAspectRatio: "none" })];
        }
        const { run, style } = item;
        const n = Math.floor(run.at.length / run.dimension);
        const places: string[] = [];
        let broken = true;
        for (let i = 0; i < n; ++i) {
            const x = run.at[i * run.dimension] ?? NaN, y = run.at[i * run.dimension + 1] ?? 0;
            if (!Number.isFinite(x) || !Number.isFinite(y)) { broken = true; continue; }
            const [a, b] = this.project([x, y]);
            if (item.kind === "dots") places.push(`M${px(a)} ${px(b)}h0`);
            else places.push(`${broken ? "M" : "L"}${px(a)} ${px(b)}`);
            broken = false;
        }
        const round = item.kind === "dots";
        return [s("path", { d: places.join(""), fill: style.fill ? paint(style.fill) : "none", stroke: paint(style.colour),
            "fill-rule": style.rule, "fill-opacity": style.fill ? style.opacity : null, "stroke-opacity": style.fill ? null : style.opacity,
            "stroke-width": style.width ?? (round ? 6 : 2), "stroke-linecap": "round", "stroke-linejoin": "round",
            "stroke-dasharray": style.dashed ? "5 5" : null })];
    }

    private grid(): void {
        const { lower, upper } = this.window;
        const lines: SVGElement[] = [];
        for (const axis of [0, 1] as const) {
            const step = round125(90 / this.scale[axis]);
            const first = Math.ceil((lower[axis] ?? 0) / step);
            for (let k = first; k * step <= (upper[axis] ?? 0) && k - first < 100; ++k) {
                const [x, y] = this.project(axis === 0 ? [k * step, 0] : [0, k * step]);
                const zero = k === 0 ? "axis" : null;
                lines.push(axis === 0 ? s("line", { x1: px(x), x2: px(x), y1: 0, y2: this.height, class: zero })
                                      : s("line", { x1: 0, x2: this.width, y1: px(y), y2: px(y), class: zero }));
                const text = shown(k * step, 6);
                lines.push(axis === 0 ? s("text", { x: px(x + 3), y: this.height - 5 }, text)
                                      : s("text", { x: 4, y: px(y - 3) }, text));
            }
        }
        this.ground.replaceChildren(...lines);
    }

    private zoom(x: number, y: number, factor: number): void {
        const at = this.unproject(x, y, []);
        const size = Math.min(1e12, Math.max(1e-12, this.scale[0] * factor)) / this.scale[0];
        this.scale = [this.scale[0] * size, this.scale[1] * size];
        this.origin = [x - (at[0] ?? 0) * this.scale[0], y + (at[1] ?? 0) * this.scale[1]];
        this.wanted = undefined;
        this.redraw();
    }

    private listen(): void {
        const svg = this.svg;
        const place = (event: MouseEvent): [number, number] => {
            const frame = svg.getBoundingClientRect();
            return [event.clientX - frame.left, event.clientY - frame.top];
        };
        svg.addEventListener("wheel", (event) => {
            event.preventDefault();
            const [x, y] = place(event);
            this.zoom(x, y, Math.exp(-event.deltaY * 0.0015));
        }, { passive: false });
        let moved = false;
        svg.addEventListener("pointerdown", (event) => {
            if (event.button === 0 && this.fingers.size === 0 && this.onGroundDrag?.(event)) return;
            svg.setPointerCapture(event.pointerId);
            this.fingers.set(event.pointerId, place(event));
            if (this.fingers.size === 1) moved = false;
        });
        svg.addEventListener("pointermove", (event) => {
            const before = this.fingers.get(event.pointerId);
            if (!before) return;
            const now = place(event);
            const other = [...this.fingers].find(([id]) => id !== event.pointerId)?.[1];
            if (Math.hypot(now[0] - before[0], now[1] - before[1]) < 2 && !moved) return;
            moved = true;
            if (other) {
                const apart = (p: [number, number]): number => Math.max(10, Math.hypot(p[0] - other[0], p[1] - other[1]));
                this.zoom(other[0], other[1], apart(now) / apart(before));
            } else {
                this.origin = [this.origin[0] + now[0] - before[0], this.origin[1] + now[1] - before[1]];
                this.wanted = undefined;
                this.redraw();
            }
            this.fingers.set(event.pointerId, now);
        });
        const release = (event: PointerEvent): void => {
            if (!this.fingers.delete(event.pointerId) || moved || event.type === "pointercancel") return;
            const [x, y] = place(event);
            this.onGround?.(this.unproject(x, y, []), event);
        };
        svg.addEventListener("pointerup", release);
        svg.addEventListener("pointercancel", release);
    }
}
