"""The words of bench/REPORT.md, from what tools/bench_report.py measured."""
import math
import statistics

TOLERANCES = (1e-3, 1e-4, 1e-5)
LOST = "🔴 "  # before what Open CASCADE does better


def median(result, threads="one_thread", clock="processor_ms"):
    return statistics.median(result[threads][clock])


def good(result):
    return result is not None and "refusal" not in result


def sewn(row):
    """No edge of the model has a face on one side only, so no edge of the mesh may have."""
    return good(row["freiform"]) and row["freiform"]["free_edges"] == 0


def bound_kept(result):
    return result["deviation"] <= result["error_bound"] + result["boundary_gap"]


def two_threads(results):
    return sum(median(r, "two_threads", "wall_ms") for r in results) / sum(median(r, "one_thread", "wall_ms") for r in results)


def geometric_mean(values):
    return math.exp(statistics.fmean(math.log(v) for v in values)) if values else math.nan


def number(x):
    return "–" if x is None else f"{x:.2g}" if x < 0.095 else f"{x:.2f}" if x < 100 else f"{x:.3g}"


def milliseconds(x):
    return f"{x:.1f}" if x < 100 else f"{x:.0f}"


def table_row(row):
    f, o = row["freiform"], row["occt"]
    cells = [row["model"], f"{row['relative']:g}"]
    if not good(f):
        return "| " + " | ".join(cells + [f"no result: {f['refusal']}"]) + " |"
    reached = row.get("occt_reached")
    pair = lambda a, b: f"{a} / {b}" if b is not None else f"{a}"
    other = lambda get: get(o) if good(o) else None if o is None else "failed"
    rated = lambda x: (LOST if x > 1 else "") + number(x)
    ratio = rated(median(f) / median(o)) if good(o) else "–"
    same = rated(median(f) / median(reached)) if reached else "–"
    share = f["tolerance"]
    cells += [
        str(f["faces"]),
        pair(f["triangles"], other(lambda r: r["triangles"])),
        rated(f["triangles"] / o["triangles"]) if good(o) else "–",
        pair(milliseconds(median(f)), other(lambda r: milliseconds(median(r)))),
        ratio,
        milliseconds(median(reached)) if reached else "–",
        same,
        pair(f["topology"]["open_edges"], other(lambda r: r["open_edges"])) + ("" if sewn(row) else " (not closed)"),
        f"{f['deviation']:.2g}" + (f" / {o['deviation']:.2g}" if good(o) else ""),
        pair(number(f["deviation"] / share), other(lambda r: number(r["deviation"] / r["tolerance"]))),
        number(f["error_bound"] / share),
        number(f["boundary_gap"] / share),
        "yes" if bound_kept(f) else "**no**",
        str(len(f["refused"])),
    ]
    return "| " + " | ".join(cells) + " |"


def listing(lines):
    return "\n".join(f"- {line}" for line in lines) if lines else "- none"


def label(row):
    return f"{row['model']} at {row['relative']:g}"


def losses(rows):
    out = []
    for row in rows:
        f, o = row["freiform"], row["occt"]
        if not good(f):
            out.append(f"{label(row)}: no result: {f['refusal']}")
            continue
        said = []
        if good(o):
            if f["triangles"] > o["triangles"]:
                said.append(f"{f['triangles'] / o['triangles']:.2f} times the triangles")
            if median(f) > median(o):
                said.append(f"{median(f) / median(o):.2f} times the time")
            if f["deviation"] / f["tolerance"] > max(1, o["deviation"] / o["tolerance"]):
                said.append("further from the surface")
        if not bound_kept(f):
            said.append(f"**deviation above the proven bound: {f['deviation']:.6g} > {f['error_bound']:.6g} + {f['boundary_gap']:.6g}**")
        if f["deviation"] > f["tolerance"]:
            said.append(f"deviation {f['deviation'] / f['tolerance']:.2f} times the tolerance, where the model's own gap is "
                        f"{f['boundary_gap'] / f['tolerance']:.2f} times the tolerance")
        t = f["topology"]
        if sewn(row) and t["open_edges"]:
            said.append(f"**{t['open_edges']} open edges in a sewn model**")
        if t["non_manifold_edges"]:
            said.append(f"{t['non_manifold_edges']} edges with more than two triangles")
        if t["degenerate_triangles"]:
            said.append(f"{t['degenerate_triangles']} triangles without area")
        least = o["degenerate_triangles"] if good(o) else 0
        if f["degenerate_triangles"] > least:
            said.append(f"{f['degenerate_triangles']} triangles with corners closer than 1e-7 of the diagonal"
                        + (f" (Open CASCADE: {least})" if good(o) else ""))
        said += [f"refused {r['face']}: {r['where']}: {r['message']}" for r in f["refused"]]
        if said:
            out.append(f"{label(row)}: " + "; ".join(said))
    return out


def wins(rows):
    out = []
    for row in rows:
        f, o = row["freiform"], row["occt"]
        if not good(f) or o is None:
            continue
        if not good(o):
            out.append(f"{label(row)}: Open CASCADE gives no result: {o['refusal']}")
            continue
        said = []
        if f["triangles"] < o["triangles"]:
            said.append(f"{f['triangles'] / o['triangles']:.2f} times the triangles")
        if median(f) < median(o):
            said.append(f"{median(f) / median(o):.2f} times the time")
        if o["deviation"] > o["tolerance"] >= f["deviation"] * o["tolerance"] / f["tolerance"]:
            said.append(f"within the tolerance, which Open CASCADE exceeds {o['deviation'] / o['tolerance']:.2f} times")
        if said:
            out.append(f"{label(row)}: " + "; ".join(said))
    return out


def summary(rows):
    done = [r for r in rows if good(r["freiform"])]
    both = [r for r in done if good(r["occt"])]
    closed = [r for r in done if sewn(r)]
    tight = [r for r in closed if r["freiform"]["topology"]["open_edges"] == 0]
    kept = [r for r in done if bound_kept(r["freiform"])]
    within = [r for r in done if r["freiform"]["deviation"] <= r["freiform"]["tolerance"]]
    theirs = [r for r in both if r["occt"]["deviation"] <= r["occt"]["tolerance"]]
    proven = [r for r in done if r["freiform"]["error_bound"] <= r["freiform"]["tolerance"]]
    lines = [
        f"Rows with a result: {len(done)} of {len(rows)}, {len(both)} of them with Open CASCADE beside.",
        f"Sewn models (solids, and closed shells) without an open edge: {len(tight)} of {len(closed)}.",
        f"Measured deviation within the proven bound and the model's gap: {len(kept)} of {len(done)}.",
        f"Proven bound within the tolerance: {len(proven)} of {len(done)}.",
        f"Measured deviation within the tolerance: {len(within)} of {len(done)}; Open CASCADE {len(theirs)} of {len(both)}.",
        f"Refused faces: {sum(len(r['freiform']['refused']) for r in done)}.",
    ]
    if not both:
        return lines
    f, o = [r["freiform"] for r in both], [r["occt"] for r in both]
    for relative in [*TOLERANCES, None]:
        some = [r for r in both if relative in (r["relative"], None)]
        where = "at all of these" if relative is None else f"at {relative:g}"
        if some:
            t = geometric_mean([r["freiform"]["triangles"] / r["occt"]["triangles"] for r in some])
            s = geometric_mean([median(r["freiform"]) / median(r["occt"]) for r in some])
            lines.append(f"Geometric mean of freiform / Open CASCADE {where}: triangles {t:.2f}, time {s:.2f}.")
        same = [r for r in some if r.get("occt_reached")]
        if same:
            s = geometric_mean([median(r["freiform"]) / median(r["occt_reached"]) for r in same])
            t = sum(r["freiform"]["triangles"] for r in same) / sum(r["occt_reached"]["triangles"] for r in same)
            each = geometric_mean([r["freiform"]["triangles"] / r["occt_reached"]["triangles"] for r in same])
            lines.append(f"The same against Open CASCADE at the deflection that reaches the tolerance: time {s:.2f}, triangles {each:.2f} "
                         f"({t:.2f} of all together), of {len(same)} rows.")
    useful = sorted(r["deviation"] / (r["error_bound"] + r["boundary_gap"]) for r in [r["freiform"] for r in done]
                    if r["error_bound"] + r["boundary_gap"] > 0)
    ours, theirs = (sum(r["triangles"] for r in x) / sum(map(median, x)) for x in (f, o))
    lines += [
        f"Measured deviation divided by the bound (and gap), median of the rows: {useful[len(useful) // 2]:.2f}.",
        f"Triangles a second, of all rows together: {1e3 * ours:.0f}, Open CASCADE {1e3 * theirs:.0f} ({ours / theirs:.1f} times).",
    ]
    lines += [
        f"Totals: {sum(r['triangles'] for r in f)} triangles in {sum(map(median, f)) / 1e3:.2f} s, Open CASCADE "
        f"{sum(r['triangles'] for r in o)} in {sum(map(median, o)) / 1e3:.2f} s, with one thread.",
        f"Wall clock with two threads, as a part of that with one: freiform {two_threads(f):.2f}, Open CASCADE {two_threads(o):.2f} "
        "(near 1 for both: probably no second processor was free, so this says nothing about the programs)."
        if min(two_threads(f), two_threads(o)) > 0.9 else
        f"Wall clock with two threads, as a part of that with one: freiform {two_threads(f):.2f}, Open CASCADE {two_threads(o):.2f}.",
    ]
    return lines


def of_copies(copies):
    """Two threads beside two copies, which show what a second processor of the machine is worth to this work."""
    alone, together, threads = (statistics.median(copies[k]) for k in ("alone_ms", "together_ms", "two_threads_ms"))
    return (f"The same of {copies['model']} at {copies['relative']:g}, once more: {threads / alone:.2f}. In the same minute two copies "
            "of the program at the same time, each with one thread on a processor of its own, which wait for nothing, took "
            f"{together / alone / 2:.2f} for each mesh.")


def interpolation(data):
    both = data.get("interpolation")
    if not both or "refusal" in both["freiform"]:
        return ""
    ours, theirs = both["freiform"], both["scipy"]
    lines = []
    for name, value in ours.items():
        mine = statistics.median(value["processor_ms"])
        other = statistics.median(theirs[name]["processor_ms"]) if name in theirs else None
        lines.append(f"| {name} | {mine:.3g} | " + (f"{other:.3g} | {mine / other:.2f}" if other else "– | –") +
                     f" | {value['bound']:.1e} |")
    table = "\n".join(lines)
    return f"""
## Interpolation, beside SciPy {theirs.get("version", "(absent)")}

Cubic splines through points in space, from given parameters, in milliseconds of processor time (median); curves through so many points,
surfaces through square grids (not-a-knot). The time of freiform includes the proven bound of the distance from the points. SciPy:
make_interp_spline, and RectBivariateSpline three times. Points: bench/tasks/interpolate.cpp.

| points | freiform | SciPy | ratio | bound |
|---|---|---|---|---|
{table}
"""


def tolerances(rows):
    """'0.001 and 0.0001'"""
    return " and ".join(f"{t:g}" for t in sorted({r["relative"] for r in rows}, reverse=True))


def report(data):
    rows, where = data["rows"], data["machine"]
    angles = []
    for key, who in (("freiform", "freiform"), ("occt", "Open CASCADE")):
        some = [r[key] for r in rows if good(r[key]) and good(r["occt"])]
        if some:
            all_triangles = sum(r["triangles"] for r in some)
            below = [sum(r["triangles"] * r["angles_below"][i] for r in some) / all_triangles for i in range(4)]
            angles.append(f"{who}: " + ", ".join(f"{100 * b:.1f} % below {limit:g}°" for b, limit in
                                                  zip(below, some[0]["angle_limits"])))
    versions = {r["occt"]["version"] for r in rows if good(r["occt"])}
    load = f"load {where['load']:.1f} before the start" if "load" in where else "busy with other work meanwhile"
    missing = [f"{m['model']}: {m['reason']}" for m in data["skipped"]]
    return f"""# Tessellation, beside Open CASCADE

Generated by tools/bench_report.py from bench/results/{data['name']}.json; `make bench` does it again. Do not edit.

Other comparisons: [evaluation of many points](EVALUATION.md), with plots against points, degree and control points;
[nearest points](NEAREST.md); [intersections](INTERSECT.md); [curves](CURVES.md). Alone: [kernels](MICRO.md) and
[thresholds](THRESHOLDS.md).

## What was measured

- Models: the 16 of Debian's packages occt-misc (/usr/share/opencascade/data) and gmsh-doc, as they are, without sewing
  or healing, the IGES files once more with their faces sewn (within the largest tolerance of the file; not timed); one free-form face of 20 x 20 control points, rational and bicubic, whole (hills) and with 25 round holes; and two
  of examples/. In the IGES files, shell1 and wing faces do not share all edges (not closed in the table); hammer.brep is a
  closed shell without a solid; all others are sewn solids.
- Tolerance: {tolerances(data['rows'])} of the diagonal of the model's tight box. Open CASCADE gets it as the deflection of
  BRepMesh_IncrementalMesh, with an angle of 0.5 radians; freiform has no angular limit. That costs Open CASCADE
  triangles where the tolerance is coarse.
- Time: the mesher alone, without reading, on one thread; the median, in processor time, of up to five repetitions in each of
  {data['rounds']} rounds, in which the two programs take turns. The time of freiform includes the proof of the bound. Absolute times wander
  from run to run and from machine to machine: compare the ratios.
- Deviation: the largest distance from ten samples inside each triangle (evenly spread over its parameters, mapped by the surface)
  to the nearest triangle of the same face, divided by the tolerance. One program text (bench/common/measure.cpp)
  measures both.
- Measured error: the same distance in the unit of the file. Time at the same error: that of Open CASCADE at the deflection with which its
  measured deviation is at most the tolerance (the first found by dividing by four, then by bisection; "–": none was found, or none at a larger tolerance, and it was not looked for), and the time of
  freiform divided by it. A red mark stands where Open CASCADE does better.
- Bound: what freiform proves of the distance between faces and mesh (`error_bound`), divided by the tolerance. Gap: how far the model
  contradicts itself along its edges (`boundary_gap`), likewise. Kept: the measured deviation is no larger than their sum.
- Open edges: used by one triangle. Of freiform by the mesh's own indices, of Open CASCADE, whose faces share no points, after
  welding within 1e-7 of the diagonal.
- Machine: {where['cpu']}, {where['cores']} cores, {load}. {data['build']['compiler']}, {data['build']['build_type']}, flags `{data['build']['flags'].strip()}`.
  freiform at {data['commit']}; Open CASCADE {', '.join(sorted(versions)) or 'absent'}, as Debian builds it.

## Summary

{listing(summary(rows) + [of_copies(c) for c in data.get("copies") or []])}

Shape of the triangles, smallest angle: {'; '.join(angles) or 'not measured'}.

## Table

Pairs are freiform / Open CASCADE; times in milliseconds.

| model | tolerance | faces | triangles | ratio | ms | ratio | ms at same error | ratio | open edges | measured error | deviation | bound | gap | kept | refused |
|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|
{chr(10).join(map(table_row, rows))}

## Losses

{listing(losses(rows))}

## Wins

{listing(wins(rows))}

## Left out

{listing(missing)}
{interpolation(data)}"""


