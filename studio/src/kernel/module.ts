// The library, loaded once. Every point that the studio draws was computed there.

import { FreiformError, load, type CommandName, type Construction, type Freiform, type Mesh, type MeshOptions, type Options, type Shape, type Source } from "freiform";
import packed from "freiform/freiform.packed?url";
import type { Curvatures, Places } from "./curvature";
import Worker from "./worker?worker";

export type { CurveJson, DocumentJson, Freiform, Mesh, ObjectJson, Point as PointJson, Shape, Source, SurfaceJson } from "freiform";
export { FreiformError };

let module: (Freiform & { readonly module: WebAssembly.Module }) | undefined;

/** Loads the module; the page waits for it once. */
export async function start(): Promise<Freiform> {
    module ??= await load(fetch(packed));
    return module;
}

/** The library. REQUIRES `start` to have ended. */
export function ff(): Freiform {
    if (!module) throw new Error("the module is not loaded");
    return module;
}

/** Makes shapes that live as long as one call. */
export type Make = (source: Source) => Shape;

/** Calls `f` and frees the shapes that it made, whatever happens. */
export function arena<T>(f: (make: Make, keep: (shape: Shape) => Shape) => T): T {
    const made: Shape[] = [];
    const keep = (shape: Shape): Shape => {
        made.push(shape);
        return shape;
    };
    try {
        return f((source) => keep(ff().shape(source)), keep);
    } finally {
        for (const shape of made) shape.free();
    }
}

/** A source whose name says what it is; `beside`: the files that it may name. */
export const file = (name: string, content: string | Uint8Array, beside: Record<string, Uint8Array> = {}): Source => ({ file: name, content, beside });

/** The levels of de Casteljau or de Boor at a parameter. */
export function construct(shape: Shape, at: readonly number[]): Construction["levels"] {
    const answer = shape.construction(at) as Construction | Construction["levels"];
    return Array.isArray(answer) ? answer : answer.levels;
}

/** What a worker is asked, and what it says. */
export type Task =
    | { readonly kind: "mesh"; readonly source: Source; readonly options: Omit<MeshOptions, "progress">; readonly also: Also }
    | { readonly kind: "curvatures"; readonly source: Source; readonly meshes: readonly Places[] }
    | { readonly kind: "section"; readonly source: Source; readonly plane: readonly number[] }
    | { readonly kind: "read"; readonly source: Source }
    | { readonly kind: "run"; readonly command: CommandName; readonly source: Source; readonly options: Options };
export interface Order { readonly module: WebAssembly.Module; readonly task: Task }
/** What is found with the triangles: distances from them, edges of models (with the size of the whole document). */
export interface Also { readonly deviations?: boolean; readonly edges?: number }
export interface Meshed {
    readonly meshes: readonly Mesh[];
    /** If asked for: of each model all of its edges, as points after each other; of other shapes none. */
    readonly edges: readonly (readonly Float64Array[])[] | undefined;
    /** If asked for: the distance from the middle of each triangle to its shape, as the nearest point there was found. */
    readonly deviations: readonly Float64Array[] | undefined;
}
/** What a file holds. */
export interface Understood { readonly document: string; readonly leftOut: readonly { readonly where: string; readonly message: string }[] }
export type News =
    | { readonly kind: "progress"; readonly part: number }
    | { readonly kind: "done"; readonly result: unknown }
    | { readonly kind: "refused"; readonly refusal: { readonly kind: string; readonly where: string; readonly message: string } };

export interface Beside<T> { readonly done: Promise<T>; cancel(): void }

function beside<T>(task: Task, progress: (part: number) => void): Beside<T> {
    if (!module) throw new Error("the module is not loaded");
    const worker = new Worker();
    const order: Order = { module: module.module, task };
    let stop: (reason: Error) => void = () => undefined;
    const done = new Promise<T>((resolve, reject) => {
        stop = reject;
        worker.onmessage = (event: MessageEvent<News>) => {
            const news = event.data;
            if (news.kind === "progress") { progress(news.part); return; }
            worker.terminate();
            if (news.kind === "done") resolve(news.result as T);
            else reject(Object.assign(new Error(news.refusal.message), news.refusal));
        };
        worker.onerror = (event) => {
            worker.terminate();
            reject(new Error(event.message || "the worker failed"));
        };
        worker.postMessage(order);
    });
    return { done, cancel: () => { worker.terminate(); stop(new DOMException("cancelled", "AbortError")); } };
}

/** Triangles of everything in a document that has a surface, computed beside the page. */
export const mesh = (source: Source, options: Omit<MeshOptions, "progress">, also: Also, progress: (part: number) => void): Beside<Meshed> =>
    beside({ kind: "mesh", source, options, also }, progress);

/** Gauss and mean curvature at the vertices of meshes of that document. */
export const curvatures = (source: Source, meshes: readonly Mesh[], progress: (part: number) => void): Beside<readonly Curvatures[]> =>
    beside({ kind: "curvatures", source, meshes: meshes.map(({ uvs, indices, parts }) => ({ uvs, indices, parts })) }, progress);

/** Where a plane meets a document, as lines of points after each other. */
export const section = (source: Source, plane: readonly number[]): Beside<readonly Float64Array[]> => beside({ kind: "section", source, plane }, () => undefined);

/** What a file holds, read beside the page. */
export const read = (source: Source): Beside<Understood> => beside({ kind: "read", source }, () => undefined);

/** The answer of a command, found beside the page. */
export const answer = (command: CommandName, source: Source, options: Options): Beside<unknown> => beside({ kind: "run", command, source, options }, () => undefined);
