// Writes the files beside this one: objects made with openNURBS, by way of the npm package rhino3dm (8.35). Files of
// version 4 and 2 have polysurfaces where those of version 8 have extrusions, so they say the same in other words.
//     npm install rhino3dm && node make.mjs
import fs from 'fs';
import rhino3dm from 'rhino3dm';

const r = await rhino3dm();

function polyline(points) {
  const p = new r.Polyline(points.length);
  for (const q of points) p.add(...q);
  return p.toPolylineCurve();
}
const circle = (centre, radius) => r.ArcCurve.createFromCircle(new r.Circle(centre, radius));
const slanted = (from, to) => {
  const e = new r.Extrusion();
  e.setPathAndUp(from, to, [0, 0, 1]);
  e.setOuterProfile(polyline([[0, 0, 0], [3, 0, 0], [3, 2, 0], [1, 2.5, 0], [0, 0, 0]]), true);
  return e;
};
const attributes = (name, layer = 0) => {
  const a = new r.ObjectAttributes();
  a.name = name;
  a.layerIndex = layer;
  return a;
};
function write(document, name, versions) {
  for (const version of versions) {
    const options = new r.File3dmWriteOptions();
    options.version = version;
    fs.writeFileSync(`${name}_${version}.3dm`, document.toByteArrayOptions(options));
  }
}

const solids = new r.File3dm();
solids.settings().modelUnitSystem = r.UnitSystem.Centimeters;
for (const name of ['Default', 'Körper']) {
  const layer = new r.Layer();
  layer.name = name;
  solids.layers().add(layer);
}
const shapes = {
  sphere: () => new r.Sphere([1, 2, 3], 4).toBrep(),
  cylinder: () => new r.Cylinder(new r.Circle([10, 0, 0], 2), 5).toBrep(true, true),
  box: () => r.Brep.createFromBoundingBox(new r.BoundingBox([30, 0, 0], [31, 2, 3])),
  pipe: () => r.Extrusion.createPipeExtrusion(new r.Cylinder(new r.Circle([40, 0, 0], 2), 5), 1, true, true),
  mitred: () => {
    const e = r.Extrusion.createCylinderExtrusion(new r.Cylinder(new r.Circle([50, 0, 0], 2), 5), true, true);
    e.miterPlaneNormalAtStart = [0.3, 0.1, 1];
    e.miterPlaneNormalAtEnd = [-0.2, 0.4, 1];
    return e;
  },
  slanted: () => {
    const e = slanted([60, 1, 2], [64, 5, 9]);
    e.addInnerProfile(circle([1.5, 1, 0], 0.4));
    return e;
  },
  'slanted, cut': () => {
    const e = slanted([70, 1, 2], [74, 5, 9]);
    e.miterPlaneNormalAtEnd = [0.2, 0.1, 1];
    return e;
  },
};
for (const [name, make] of Object.entries(shapes)) {
  const g = make();
  if (!g) throw name;
  const a = attributes(name, name === 'box' ? 1 : 0);
  if (name === 'box') {
    a.objectColor = {r: 255, g: 102, b: 0, a: 255};
    a.colorSource = r.ObjectColorSource.ColorFromObject;
  }
  solids.objects().add(g, a);
}
write(solids, 'solids', [2, 4, 8]);

const sheets = new r.File3dm();
const open = {
  wall: r.Extrusion.create(new r.LineCurve([0, 0, 0], [1, 3, 0]), 4, false),
  'part of a cone': r.RevSurface.create(new r.LineCurve([12, 0, 0], [11, 0, 3]), new r.Line([10, 0, 0], [10, 0, 1]), 0.5, 2.5),
  'cone with its tip': r.RevSurface.create(new r.LineCurve([22, 0, 0], [20, 0, 3]), new r.Line([20, 0, 0], [20, 0, 1]), 0, 2 * Math.PI),
  bowl: r.RevSurface.create(
      r.ArcCurve.createFromArc(r.Arc.createFromPoints([32, 0, 0], [31.5, 0, 2], [30, 0, 2.5])), new r.Line([30, 0, 0], [30, 0, 1]), 0, 2 * Math.PI),
  rectangle: new r.PlaneSurface({origin: [40, 2, 3], xAxis: [0, 1, 0], yAxis: [0, 0, 1], zAxis: [1, 0, 0]}, [0, 2], [1, 4]),
  sphere: new r.Sphere([52, 2, 3], 4).toNurbsSurface(),
};
for (const [name, g] of Object.entries(open)) {
  if (!g) throw name;
  sheets.objects().add(g, attributes(name));
}
sheets.objects().add(new r.Point([1, 2, 3]), attributes('point'));
sheets.objects().add(new r.LineCurve([0, 0, 0], [1, 1, 1]), attributes('line'));
write(sheets, 'sheets', [4, 8]);

const curves = new r.File3dm();
const row = new r.PolyCurve();
row.appendCurve(new r.LineCurve([0, 0, 0], [1, 0, 0]));
row.appendCurve(r.ArcCurve.createFromArc(r.Arc.createFromPoints([1, 0, 0], [1 + Math.SQRT1_2, 1 - Math.SQRT1_2, 0], [2, 1, 0])));
for (const [name, g] of Object.entries({
       line: new r.LineCurve([1, 2, 3], [4, 5, 6]), circle: circle([0, 0, 5], 2), polyline: polyline([[0, 0, 0], [1, 0, 0], [1, 1, 0], [2, 3, 4]]),
       row, spline: r.NurbsCurve.create(true, 3, [[0, 0, 0], [4, 0, 0], [4, 4, 1], [0, 4, 0]])
     })) {
  if (!g) throw name;
  curves.objects().add(g, attributes(name));
}
write(curves, 'curves', [3, 7]);

const blocks = new r.File3dm();
const box = r.Brep.createFromBoundingBox(new r.BoundingBox([0, 0, 0], [1, 2, 3]));
blocks.instanceDefinitions().add('box', '', '', '', [0, 0, 0], [box], [attributes('part')]);
const id = blocks.instanceDefinitions().get(0).id;
const place = (name, rows) => {
  const t = new r.Transform(1);
  rows.forEach((row, i) => row.forEach((x, j) => { t[`m${i}${j}`] = x; }));
  blocks.objects().add(new r.InstanceReference(id, t), attributes(name));
};
place('moved', [[1, 0, 0, 10], [0, 1, 0, 20], [0, 0, 1, 30], [0, 0, 0, 1]]);
place('mirrored', [[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]);
place('twice as large', [[0, -2, 0, 0], [2, 0, 0, 0], [0, 0, 2, -20], [0, 0, 0, 1]]);
place('stretched', [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]]);
place('stretched mirror', [[1, 0, 0, 20], [0, 1, 0, 0], [0, 0, -2, 0], [0, 0, 0, 1]]);
write(blocks, 'blocks', [4, 8]);
