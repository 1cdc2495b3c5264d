// Time for one point, in nanoseconds: what bench-micro-evaluation measures of the kernels natively (first_derivatives,
// second_derivatives, grid), with the way through the interface and the copy of the answer, into arrays that are there:
// new memory for each answer can take eight times as long as a grid. A page has no clock of its own processor time, so
// the least of the repetitions is taken, which other programs disturb least. Each kind of work is done for a second
// before, while engines optimise in the background what is called often. `ff` is the loaded module.
export function speed(ff, repetitions = 100) {
  const n = 20, degree = 3;
  let state = 2001;
  const next = () => (state = (state * 16807) % 2147483647) / 2147483647;
  const knots = [...Array(degree).fill(0), ...Array.from({ length: n - degree + 1 }, (_, i) => i / (n - degree)), ...Array(degree).fill(1)];
  const net = (f) => Array.from({ length: n }, (_, i) => Array.from({ length: n }, (_, j) => f(i, j)));
  const s = ff.shape({
    type: 'surface', degrees: [degree, degree], knots: [knots, knots],
    points: net((i, j) => [i + next(), j + next(), next()]), weights: net(() => 0.5 + next()),
  });
  const at = Float64Array.from({ length: 2 * 4096 }, next);
  const axis = Float64Array.from({ length: 100 }, (_, i) => (i + 0.5) / 100);
  const first = new Float64Array(4096 * 9), second = new Float64Array(4096 * 18), grid = s.grid([axis, axis]);
  const jobs = {
    'first_derivatives/4096/3': [4096, () => s.evaluate(at, { derivatives: 1, out: first })],
    'second_derivatives/4096/3': [4096, () => s.evaluate(at, { derivatives: 2, out: second })],
    'grid/100/3/20': [10000, () => s.grid([axis, axis], { out: grid })],
  };
  const answer = {};
  for (const [name, [points, run]] of Object.entries(jobs)) {
    for (const begin = performance.now(); performance.now() - begin < 1000;) run();
    const times = [];
    for (let r = 0; r < repetitions; ++r) {
      const start = performance.now();
      for (let i = 0; i < 3; ++i) run();
      times.push(((performance.now() - start) * 1e6) / (3 * points));
    }
    answer[name] = Math.min(...times);
  }
  s.free();
  return answer;
}
