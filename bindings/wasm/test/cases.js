// What the module has to do, wherever it runs: in node (module.test.js) and in a page (browser.js). No imports: `ff` is
// the loaded module, FreiformError its class.

export function check(condition, what) {
  if (!condition) throw new Error(what);
}

// The first place where two answers differ by more than rounding, or null. Times are not compared.
export function difference(a, b, where = '$', scale = sizeOf(a)) {
  if (typeof a === 'number' && typeof b === 'number')
    return Math.abs(a - b) <= 1e-11 * Math.max(scale, Math.abs(a)) ? null : `${where}: ${a} and ${b}`;
  if (a === null || b === null || typeof a !== 'object' || typeof b !== 'object')
    return a === b ? null : `${where}: ${JSON.stringify(a)} and ${JSON.stringify(b)}`;
  const keys = Object.keys(a), others = Object.keys(b);
  if (keys.join() !== others.join()) return `${where}: ${keys.join().slice(0, 90)} and ${others.join().slice(0, 90)}`;
  for (const key of keys) {
    if (key === 'seconds') continue;
    const d = difference(a[key], b[key], `${where}.${key}`, scale);
    if (d) return d;
  }
  return null;
}
function sizeOf(a) {
  if (typeof a === 'number') return Math.abs(a);
  if (a === null || typeof a !== 'object') return 0;
  return Math.min(1e6, Object.values(a).reduce((most, x) => Math.max(most, sizeOf(x)), 0));
}

// Questions to every document; a refusal is an answer too.
export const questions = [
  ['info', '--json'],
  ['eval', '--at', '0.3;0.3,0.6;0.2,0.4,0.6', '--derivatives', '2', '--json'],
  ['eval', '--at', '0.25', '--object', '0', '--construction', '--json'],
  ['convert', '--elevate', '1'],
  ['convert', '--to-bezier', '--reverse'],
  ['bounds', '--json'],
  ['length', '--json'],
  ['features', '--json'],
  ['continuity', '--json'],
  ['flatten', '--tolerance', '0.01', '--json'],
  ['tessellate', '--tolerance', '0.05', '--json'],
  ['basis', '--to-basis', 'monomial', '--object', '0', '--json'],
];

const cubic = { type: 'curve', points: [[0, 0], [1, 2], [3, 2], [4, 0]] };
const patch = {
  type: 'surface', degrees: [2, 1], points: [[[0, 0, 0], [0, 1, 0]], [[1, 0, 1], [1, 1, 1]], [[2, 0, 0], [2, 1, 0]]],
};
const near = (a, b, most = 1e-12) => Math.abs(a - b) <= most;
const nearAll = (a, b, most) => a.length === b.length && Array.from(a).every((x, i) => near(x, b[i], most));

function refusal(f) {
  try {
    f();
  } catch (error) {
    return error;
  }
  throw new Error('a refusal was expected');
}

export const tests = {
  'a curve is evaluated with its derivatives': (ff) => {
    const curve = ff.shape(cubic);
    check(nearAll(curve.evaluate([0, 0.5, 1]), [0, 0, 2, 1.5, 4, 0]), 'values');
    check(nearAll(curve.evaluate([0.5], { derivatives: 1 }), [2, 1.5, 4.5, 0]), 'first derivative');
    check(nearAll(curve.evaluate([0.5], { derivatives: 3 }).slice(6), [-12, 0]), 'third derivative');
    check(curve.valueErrorBound > 0 && curve.valueErrorBound < 1e-13, 'the bound of values');
    const out = new Float64Array(2);
    check(curve.evaluate([1], { out }) === out && out[0] === 4, 'the array of the caller');
    curve.free();
    check(refusal(() => curve.evaluate([0])).kind === 'usage', 'freed');
  },

  'a shape says what it is, and is what was read': (ff) => {
    const s = ff.shape({ ...patch, name: 'roof' });
    check(s.name === 'roof' && s.type === 'surface' && s.parameters === 2 && s.dimension === 3 && !s.rational, 'facts');
    check(nearAll(s.degrees, [2, 1]) && nearAll(s.size, [3, 2]), 'degrees and sizes');
    check(nearAll(s.knots[0], [0, 0, 0, 1, 1, 1]) && nearAll(s.domain[1], [0, 1]), 'knots and domain');
    check(nearAll(s.points, patch.points.flat(2)) && nearAll(s.weights, [1, 1, 1, 1, 1, 1]), 'points and weights');
    check(JSON.stringify(s.json().points) === JSON.stringify(patch.points), 'the same points again');
    const closed = ff.shape({ type: 'curve', degree: 2, closed: true, knots: [0, 1, 2, 3], points: [[0, 0], [1, 0], [0, 1]] });
    check(closed.closed[0] && closed.knots[0].length === 4, 'a closed curve has the breaks of a period');
    s.free(); closed.free();
  },

  'dragging makes a new shape of the same kind': (ff) => {
    const s = ff.shape(cubic), moved = s.with([0, 0, 1, 4, 3, 2, 4, 0]), heavy = s.with(s.points, [1, 2, 2, 1]);
    check(near(moved.evaluate([0.5])[1], 2.25), 'moved');
    check(heavy.rational && near(heavy.evaluate([0.5])[1], 12 / 7), 'weights');
    const r = refusal(() => s.with([0, 0]));
    check(r.kind === 'invalid' && r.where === 'points', 'too few points');
    check(refusal(() => s.with(s.points, [1, -1, 1, 1])).where.startsWith('weights'), 'negative weight');
    for (const x of [s, moved, heavy]) x.free();
  },

  'a grid has points, normals and curvatures': (ff) => {
    const s = ff.shape(patch), g = s.grid([[0, 0.5, 1], [0, 1]], { normals: true, curvatures: true });
    check(nearAll(g.points.slice(6, 12), [1, 0, 0.5, 1, 1, 0.5]), 'points');
    check(nearAll(g.normals.slice(6, 9), [0, 0, 1]) && nearAll(g.gauss, Array(6).fill(0)), 'normals');
    check(near(g.mean[2], -0.5), `mean curvature ${g.mean[2]}`);
    check(refusal(() => s.grid([[0, 2], [0]])).kind === 'out_of_domain', 'outside');
    const moved = s.grid([[0, 0.25, 1], [0, 1]], { normals: true }), points = moved.points, normals = moved.normals;
    const again = s.grid([[0, 0.5, 1], [0, 1]], { normals: true, out: moved });
    check(again.points === points && again.normals === normals, 'filled');
    check(nearAll(points, g.points) && nearAll(normals, g.normals), 'filled again');
    check(refusal(() => s.grid([[0], [0]], { out: { points } })).where === 'out.points', 'room for points');
    check(refusal(() => s.grid([[0], [0]], { out: { normals } })).where === 'out.normals', 'room for normals');
    s.free();
  },

  'basis functions add up to one': (ff) => {
    const s = ff.shape({ type: 'curve', degree: 2, knots: [0, 0, 0, 1, 2, 2, 2], points: [[0], [1], [1], [0]] });
    const b = s.basis([0, 0.5, 1.5]);
    check(b.length === 12 && near(b[4] + b[5] + b[6] + b[7], 1) && near(b[4], 0.25), 'values');
    const d = s.basis([0.5], { order: 1 });
    check(near(d.reduce((x, y) => x + y), 0) && near(d[0], -1), 'derivatives');
    check(refusal(() => s.basis([3])).where === 'at[0]', 'outside');
    s.free();
  },

  'de Casteljau shows all its points': (ff) => {
    const s = ff.shape(cubic), c = s.construction([0.5]);
    check(c.levels.length === 4 && c.levels[3].points[0][1] === 1.5 && c.bound < 1e-14, JSON.stringify(c).slice(0, 200));
    s.free();
  },

  'the nearest point comes with a lower bound': (ff) => {
    const s = ff.shape(cubic), n = s.nearest([2, 3, 0, -1]);
    check(near(n.parameters[0], 0.5) && near(n.distances[0], 1.5) && near(n.distances[1], 1), 'places');
    check(n.lowerBounds[0] <= n.distances[0] && n.lowerBounds[0] > 1.5 - 1e-9, 'bounds');
    s.free();
  },

  'a mesh is within its tolerance': (ff) => {
    const [sphere] = ff.document(ff.run('quadric', 'sphere', { radius: 2 }).json).shapes;
    const shares = [];
    const m = sphere.mesh({ tolerance: 0.01, progress: (part) => { shares.push(part); } });
    check(m.errorBound > 0 && m.errorBound <= 0.01 && m.openEdges === 0 && m.refused.length === 0, 'the bound');
    check(m.indices.length % 3 === 0 && m.positions.length === m.normals.length && m.parts[0].count * 3 === m.indices.length, 'sizes');
    check(Math.max(...m.indices) < m.positions.length / 3, 'indices');
    for (let i = 0; i < m.positions.length; i += 3) {
      const r = Math.hypot(m.positions[i] + m.origin[0], m.positions[i + 1] + m.origin[1], m.positions[i + 2] + m.origin[2]);
      check(near(r, 2, 1e-5), `a vertex at ${r}`);
    }
    check(shares.length > 0, 'progress is said');
    check(refusal(() => sphere.mesh({ tolerance: 0.01, progress: () => false })).kind === 'limit', 'cancelled');
    check(refusal(() => sphere.mesh({ tolerance: -1 })).kind === 'invalid', 'a negative tolerance');
    const n = sphere.nearest([0, 0, 5]);
    check(near(n.distances[0], 3, 1e-9), 'nearest of a surface');
    sphere.free();
  },

  'commands take objects, points, words and options': (ff) => {
    const document = ff.run('extrude', cubic, { by: [0, 0, 1] }).json;
    check(document.objects[0].type === 'surface', 'extrude');
    check(ff.run('interpolate', [[0, 0], [1, 1], [2, 0], [3, 1]], { degree: 3 }).json.objects[0].degree === 3, 'interpolate');
    const swept = ff.run('sweep', cubic, { rail: { type: 'curve', points: [[0, 0, 0], [0, 0, 3]] }, translate: true }).json;
    check(swept.objects[0].type === 'surface', 'sweep along a rail');
    const met = ff.run('intersect', [cubic, { type: 'curve', points: [[0, 1], [4, 1]] }]).json;
    check(JSON.stringify(met).includes('crossing'), 'intersect');
    const n = ff.run('nearest', cubic, { points: [[2, 3]] }).json.results[0];
    check(near(n.distance, 1.5) && n.lower_bound <= n.distance, 'nearest');
    check(ff.run('eval', cubic, { at: [[0], [0.5], [1]] }).json.results.length === 3, 'parameters in rows');
    const finer = ff.run('convert', cubic, { insertKnots: [0.25, 0.5] }).json;
    check(finer.objects[0].points.length === 6, 'insertKnots');
    const picture = ff.run('draw', cubic, { to: 'svg', control: true });
    check(picture.text.includes('<svg') && picture.text.includes('</svg>'), 'draw');
    const glb = ff.run('tessellate', patch, { to: 'glb', tolerance: 0.01 });
    check(new TextDecoder().decode(glb.bytes.slice(0, 4)) === 'glTF' && glb.report.triangles > 0, 'glb');
    check(ff.run('tessellate', patch, { to: 'stl', tolerance: 0.01 }).bytes.length > 84, 'stl');
    check(ff.commands.some((c) => c.name === 'flatten' && c.options.some((o) => o.name === '--tolerance')), 'descriptions');
  },

  'files of other formats are read': (ff) => {
    const svg = '<?xml version="1.0"?><!-- a --><svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 10 10"><style>path { fill: red }</style>' +
      '<g transform="translate(1,0)"><path id="p&amp;q" d="M0 0C1 2 3 2 4 0"/></g></svg>';
    const { shapes } = ff.document(svg);
    check(shapes.length === 1 && shapes[0].name === 'p&q' && nearAll(shapes[0].points, [1, 0, 2, -2, 4, -2, 5, 0]), 'svg');
    check(ff.document({ file: 'a.bpt', content: '1\n1 1\n0 0 0\n1 0 0\n0 1 0\n1 1 1\n' }).shapes[0].type === 'surface', 'bpt');
    check(refusal(() => ff.document('<svg><path></svg>')).kind === 'unreadable', 'tags that do not match');
    for (const s of shapes) s.free();
  },

  'refusals say what, where and why': (ff) => {
    let r = refusal(() => ff.shape({ type: 'curve', degree: 3, knots: [0, 0, 0, 0, 1, 0.5, 1, 1, 1], points: [[0], [1], [2], [3], [4]] }));
    check(r.name === 'FreiformError' && r.kind === 'invalid' && r.where.includes('knots[5]'), `${r.kind} ${r.where}`);
    check(r instanceof Error && r.message.includes('0.5'), r.message);
    r = refusal(() => ff.run('flatten', cubic, { tolerance: 'x' }));
    check(r.kind === 'usage' && r.message.includes('--tolerance'), r.message);
    r = refusal(() => ff.run('flatten', cubic, { tolerant: 1 }));
    check(r.message.includes('did you mean "--tolerance"'), r.message);
    r = refusal(() => ff.run('flaten', cubic));
    check(r.kind === 'usage' && r.message.includes('flatten'), r.message);
    check(refusal(() => ff.run('info', { file: 'a.step', content: 'ISO-10303-21;' })).kind === 'unreadable', 'STEP that ends too soon');
    check(refusal(() => ff.run('info', { file: 'a.step', content: 'ISO-10303-21;' }, { reader: 'occt' })).kind === 'unavailable', 'STEP by another reader');
    check(refusal(() => ff.document({ file: 'a.iges', content: 'S' })).kind === 'unavailable', 'IGES');
    check(refusal(() => ff.shape(cubic).evaluate([2])).kind === 'out_of_domain', 'outside');
    check(refusal(() => ff.shape({ objects: [] })).kind !== undefined, 'no object');
    // After all this the module works as before.
    check(near(ff.run('length', cubic).json.value, 5.268365543018514), 'still there');
    check(nearAll(ff.shape(cubic).evaluate([0]), [0, 0]), 'still there');
  },

  'many calls do not use up memory': (ff) => {
    const s = ff.shape(cubic);
    const at = new Float64Array(2000);
    const work = (times) => {
      for (let i = 0; i < times; ++i) {
        const moved = s.with(s.points);
        moved.evaluate(at);
        moved.free();
      }
    };
    work(200);
    const before = ff.memory;
    work(3000);
    check(ff.memory === before, `${before} became ${ff.memory}`);
    s.free();
  },
};
