// What objects in space are painted with.

import * as THREE from "three";
import { h } from "../ui/dom";
import { colour } from "../ui/theme";

export type Look = "shaded" | "zebra" | "isophotes" | "normals" | "flat";

export interface SurfaceStyle {
    readonly colour?: string;
    readonly opacity?: number;
    readonly look?: Look;
    readonly edges?: boolean;
}

const kLooks: Record<Look, number> = { shaded: 0, zebra: 1, isophotes: 2, normals: 3, flat: 4 };

/** Stripes are the reflection of a striped room; they are computed for each pixel from the module's normals. */
export function material(style: SurfaceStyle, coloured: boolean): THREE.MeshStandardMaterial {
    const base = new THREE.MeshStandardMaterial({
        color: coloured ? "#ffffff" : paint(style.colour ?? "surface"), vertexColors: coloured, side: THREE.DoubleSide, roughness: 0.55,
        metalness: 0.05, transparent: (style.opacity ?? 1) < 1, opacity: style.opacity ?? 1, flatShading: style.look === "flat",
        polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
    const look = kLooks[style.look ?? "shaded"];
    if (look === 0 || look === 4) return base;
    base.onBeforeCompile = (shader) => {
        shader.fragmentShader = shader.fragmentShader.replace("#include <opaque_fragment>", `
            vec3 seen = normalize(normal);
            ${look === 1 ? `vec3 ray = reflect(normalize(-vViewPosition), seen);
                float phase = 12.0 * atan(ray.y, length(ray.xz) + 1e-6) / 1.5708;` : ""}
            ${look === 2 ? "float phase = 14.0 * acos(clamp(dot(seen, normalize(vec3(0.4, 0.7, 0.6))), -1.0, 1.0)) / 1.5708;" : ""}
            ${look === 3 ? "outgoingLight = 0.5 + 0.5 * seen;" : `
                float width = fwidth(phase) + 1e-4;
                float stripe = smoothstep(0.25 - width, 0.25 + width, abs(fract(phase) - 0.5));
                outgoingLight = mix(vec3(0.06), vec3(0.93), stripe);`}
            #include <opaque_fragment>`);
    };
    base.customProgramCacheKey = () => `look${look}`;
    return base;
}

export const paint = (name: string): THREE.Color => new THREE.Color(name.startsWith("#") ? name : colour(name) || "#888");

/** Frees what the graphics card keeps of an object. */
export function discard(object: THREE.Object3D): void {
    const it = object as Partial<THREE.Mesh>;
    it.geometry?.dispose();
    for (const look of Array.isArray(it.material) ? it.material : [it.material]) look?.dispose();
}

let sprite: THREE.Texture | undefined;

/** A round dot. */
export function disc(): THREE.Texture {
    if (sprite) return sprite;
    const canvas = h("canvas", { width: 32, height: 32 });
    const pen = canvas.getContext("2d");
    if (pen) {
        pen.fillStyle = "#fff";
        pen.arc(16, 16, 15, 0, 2 * Math.PI);
        pen.fill();
    }
    sprite = new THREE.CanvasTexture(canvas);
    return sprite;
}
