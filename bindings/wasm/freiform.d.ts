// freiform for node and browsers: curves and surfaces whose answers carry a bound that holds.
//
//     import { load } from 'freiform';
//     const ff = await load();                                  // or load(url), load(bytes), load(module)
//     const curve = ff.shape({ type: 'curve', points: [[0, 0], [1, 2], [3, 2], [4, 0]] });
//     curve.evaluate([0, 0.5, 1]);                              // Float64Array [x, y, x, y, x, y]
//     ff.run('flatten', curve.json(), { tolerance: 0.01 }).json;  // any command of the program
//
// Two ways in. What is asked many times a second (values, grids, meshes, nearest points) are functions of shapes, with
// typed arrays in and out. Everything else is `run`: the commands of the command line, with files in memory; options,
// answers and refusals are those of `freiform COMMAND --help` and `--json`.
//
// A refusal is thrown as FreiformError. Shapes hold memory of the module until `free()`; all else is plain data of the
// caller's own. Nothing is asynchronous but `load`: put what takes long into a worker.

export type Numbers = ArrayLike<number>;

// Stable kinds (docs/refusals.md), 'usage' for wrong calls, 'crash' after which the module has to be loaded anew.
export type RefusalKind =
  | 'invalid' | 'nonfinite' | 'out_of_domain' | 'unreadable' | 'unsupported' | 'unavailable' | 'limit'
  | 'not_converged' | 'ill_conditioned' | 'no_answer' | 'io' | 'usage' | 'crash';

export class FreiformError extends Error {
  readonly kind: RefusalKind;
  readonly where: string; // "objects[2].knots[3]"; may be empty
  readonly reason: string; // the message without the place
  constructor(kind: RefusalKind, where: string, message: string);
}

// The document (docs/document.md) -----------------------------------------------------------------------------------

export type Point = number[];
export interface CurveJson {
  type?: 'curve'; name?: string; degree?: number; knots?: number[]; points: Point[]; weights?: number[]; closed?: boolean;
}
export interface SurfaceJson {
  type: 'surface'; name?: string; degrees?: [number, number]; knots?: [number[], number[]];
  points: Point[][]; weights?: number[][]; material?: string;
}
export interface VolumeJson {
  type: 'volume'; name?: string; degrees?: [number, number, number]; knots?: [number[], number[], number[]];
  points: Point[][][]; weights?: number[][][];
}
export interface TriangleJson { type: 'triangle'; name?: string; degree?: number; points: Point[]; weights?: number[] }
export interface HermiteJson { type: 'hermite'; name?: string; points: [Point, Point]; tangents: [Point, Point] }
export interface TrimmedJson { type: 'trimmed'; name?: string; surface: SurfaceJson; loops: CurveJson[][] }
export interface ModelJson { type: 'model'; name?: string; [field: string]: unknown }
export type ObjectJson = CurveJson | SurfaceJson | VolumeJson | TriangleJson | HermiteJson | TrimmedJson | ModelJson;
export interface DocumentJson { freiform: 1; unit?: string; objects: ObjectJson[] }

// Whatever can be read: an object, a document, or the text or bytes of a file (.json, .bpt, .svg, .obj, .bsp, .map).
// Where neither the content nor a `.json` says what it is (.obj, .map): with its name. `beside`: the files that it says
// parts of it are in, by their paths from its folder (STEP).
export interface NamedFile { file: string; content: string | Uint8Array; beside?: Record<string, string | Uint8Array> }
export type Source = DocumentJson | ObjectJson | Shape | NamedFile | string | Uint8Array;

// Shapes ------------------------------------------------------------------------------------------------------------

export type ShapeType = 'curve' | 'surface' | 'volume' | 'triangle' | 'trimmed' | 'model';

export interface Shape {
  readonly name: string;
  readonly type: ShapeType;
  readonly parameters: number; // 1, 2, 3; of a model 0
  readonly dimension: number; // coordinates of a point
  readonly rational: boolean;
  readonly degrees: readonly number[]; // per parameter; of a triangle one
  readonly size: readonly number[]; // control points per parameter; of a triangle one
  readonly knots: readonly Float64Array[]; // full knot vectors; of a triangle none
  readonly closed: readonly boolean[];
  readonly domain: readonly (readonly [number, number])[]; // per parameter
  readonly points: Float64Array; // size[0] * size[1] * .. * dimension numbers, the last index fastest
  readonly weights: Float64Array; // all 1 if not rational
  json(): ObjectJson;
  free(): void;

  // The same with other control points (and weights): what dragging needs. A new shape.
  with(points: Numbers, weights?: Numbers): Shape;

  // At `at` (parameters after each other: u, u, .. or u, v, u, v, ..). Without derivatives n * dimension numbers; with
  // derivatives: K for each parameter the value and all partial derivatives to order K in graded order (S, Su, Sv,
  // Suu, Suv, Svv). Of curves, surfaces, volumes and triangles.
  evaluate(at: Numbers, options?: { derivatives?: number; out?: Float64Array }): Float64Array;
  // A bound of |computed - exact| of each coordinate that `evaluate` gives without derivatives.
  readonly valueErrorBound: number;
  // On the tensor grid of the axes, the last axis fastest; of curves, surfaces and volumes. Normals (unit vectors of
  // Su x Sv, zero where that is zero) and curvatures are for surfaces in space. Points and normals go into the arrays of
  // `out` (a grid of the same size will do) where it has them: what is asked for each picture need not take new memory.
  grid(axes: Numbers[], options?: {
    normals?: boolean; curvatures?: boolean; out?: { points?: Float64Array; normals?: Float64Array };
  }): Grid;
  // Values (order 0) or derivatives of all basis functions along an axis: at.length * size[axis] numbers, row by row.
  basis(at: Numbers, options?: { axis?: number; order?: number }): Float64Array;
  // All intermediate points of de Casteljau and de Boor at a parameter.
  construction(at: number | Numbers): Construction;
  // The nearest points of this shape to each of `points` (coordinates after each other), with the proof. Of all types.
  nearest(points: Numbers, options?: { accuracy?: number }): Nearest;
  // Triangles within the tolerance, watertight where the shape is closed. Of surfaces, triangles, trimmed and models.
  mesh(options: MeshOptions): Mesh;
  // Polyline of a curve (edges of a model: one for each) within the tolerance.
  polylines(tolerance: number): Polyline[];
}

export interface Grid {
  points: Float64Array;
  normals?: Float64Array;
  gauss?: Float64Array; // NaN where there is no normal
  mean?: Float64Array;
}
export interface Construction {
  // Of a curve level r has `extent` [degree - r + 1]; of a surface every level [r, s].
  levels: { level: number[]; extent: number[]; points: number[][]; weights?: number[] }[];
  bound: number; // no coordinate is off by more
}
export interface Nearest {
  parameters: Float64Array; // `parameters` numbers for each point (of a model: u, v of the face)
  points: Float64Array;
  distances: Float64Array;
  lowerBounds: Float64Array; // no point of the shape is nearer: a bound
  faces?: Int32Array; // of a model
}
export interface Polyline {
  points: Float64Array;
  parameters: Float64Array;
  bound: number; // no point of the curve is farther from the polyline
}
export interface MeshOptions {
  tolerance: number; // a distance
  maxEdge?: number;
  maxAngle?: number; // degrees
  quads?: boolean;
  maxTriangles?: number;
  // A fraction in [0, 1] from time to time; false stops with a refusal (limit).
  progress?: (part: number) => boolean | void;
}
export interface Mesh {
  positions: Float32Array; // x, y, z for each vertex, relative to `origin`
  origin: [number, number, number];
  normals: Float32Array;
  uvs: Float64Array; // parameters u, v on the surface of the face
  indices: Uint32Array; // three for each triangle, counter-clockwise from outside
  parts: MeshPart[]; // one per face that was meshed: what it has of `indices`
  refused: { face: number; name: string; kind: RefusalKind; where: string; message: string }[];
  errorBound: number; // a bound, docs/algorithms/tessellate.md
  boundaryGap: number;
  openEdges: number;
  nonManifoldEdges: number;
  points: number; // points that are different; vertices share them between faces
  seconds: number;
}
export interface MeshPart {
  face: number;
  name: string;
  colour: [number, number, number] | null; // linear, 0 to 1
  first: number; // triangle
  count: number; // triangles
  errorBound: number;
}

// Commands ----------------------------------------------------------------------------------------------------------

export type CommandName =
  | 'info' | 'eval' | 'basis' | 'convert' | 'tessellate' | 'check' | 'bounds' | 'features' | 'draw' | 'conic' | 'implicit'
  | 'continuity' | 'inside' | 'nearest' | 'distance' | 'intersect' | 'section' | 'interpolate' | 'flatten' | 'path'
  | 'length' | 'fit' | 'ease' | 'gradient' | 'animate' | 'revolve' | 'extrude' | 'ruled' | 'sweep' | 'loft' | 'coons'
  | 'quadric';

// `tolerance: 0.01` is --tolerance 0.01, `insertKnots: [0.25, 0.5]` is --insert-knots 0.25,0.5, `reverse: true` is
// --reverse, `at: [[0, 0.5], [1, 1]]` is --at 0,0.5;1,1; undefined and false are left out. A value that is an object or
// bytes becomes a file: `rail: curveJson`.
export type OptionValue = string | number | boolean | undefined | Numbers | Numbers[] | Source;
export type Options = Record<string, OptionValue>;

export interface Reply {
  json: any; // the answer with --json; of commands that make a document, the document
  bytes: Uint8Array; // what went to standard output or, with `to`, the file that was made
  text: string; // the same as text
  report: any; // of commands that make a file: what --json says about it, or null
  remarks: string[]; // what the program says to people beside the answer
}

export interface CommandDescription {
  name: string;
  description: string;
  examples: string;
  options: { name: string; value: string; help: string; required: boolean; words: string[] }[];
}

export interface Freiform {
  readonly version: string;
  readonly instructions: string; // 'simd128'

  // One object, or a document with exactly one.
  shape(source: Source): Shape;
  // All objects of a document or file.
  document(source: Source): { unit: string; shapes: Shape[]; leftOut: { where: string; message: string }[] };
  // The document of these shapes.
  json(shapes: Shape[], unit?: string): DocumentJson;

  // A command of the program on one or more inputs:
  //     run('revolve', profile, { axis: [0, 0, 0, 0, 0, 1] }).json            a document
  //     run('intersect', [a, b]).json                                          the answer
  //     run('draw', document, { to: 'svg', control: true }).text               a picture
  //     run('tessellate', document, { to: 'glb', tolerance: 0.01 }).bytes      a file; .report says what was reached
  //     run('quadric', ['sphere'], { radius: 2 }).json                         a word instead of a file
  //     run('interpolate', [[0, 0], [1, 1], [2, 0]], { degree: 2 }).json       points
  //     run('nearest', curve, { points: [[2, 3]] }).json                       an option that wants a file
  // Inputs that are strings: words as they are if they are short and have no line break or bracket, else texts of files.
  // Without `to` the answer (of commands that make something, a document) is in .json; with it the file in .bytes.
  // Faces that cannot be meshed are missing in the file; .report.refused names them, and .remarks says so.
  run(command: CommandName, inputs?: Source | Source[] | Point[] | Point[][], options?: Options): Reply;
  // The same as a person types it, with files by name; files that it makes are in `files`.
  command(args: string[], files?: Record<string, string | Uint8Array>): {
    code: number; stdout: Uint8Array; stderr: string; files: Record<string, Uint8Array>;
  };
  readonly commands: CommandDescription[];

  // Bytes of memory that the module holds.
  readonly memory: number;
}

// Where a STEP file says that parts of it may be: paths from its folder, those that it names and the same without folders.
export function filesNamedIn(content: string | Uint8Array): string[];

// Without a source: freiform.packed beside this file. Modules may be packed or not, which their bytes say; those that are
// damaged are refused ('unreadable'). Modules can be posted to workers: `load(ff.module)`.
export function load(source?: string | URL | BufferSource | WebAssembly.Module | Response | Promise<Response>):
  Promise<Freiform & { readonly module: WebAssembly.Module }>;
