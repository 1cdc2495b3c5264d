// What is tested in the browser: name, what is done, and with which browser.
import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const example = (name) => fileURLToPath(new URL(`../../../examples/${name}`, import.meta.url));
const bracket = () => readFileSync(example("bracket.step"), "utf8");
/** One of its surfaces is of a kind that no reader knows. */
const odd = () => bracket().replace("TOROIDAL_SURFACE(", "WRINKLED_SURFACE(");
const kRows = Array.from({ length: 36 }, (_, i) => `R${i + 1}`);
const settle = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done)))));
/** Waits until `f` is true in the page. (What Playwright has for this evaluates text, which the page's policy forbids.) */
async function until(page, f, arg) {
    const last = Date.now() + 60000;
    while (!(await page.evaluate(f, arg).catch(() => false))) {
        if (Date.now() > last) throw new Error(`never: ${f}`);
        await new Promise((done) => setTimeout(done, 50));
    }
}
const go = async (page, url, hash, ready) => { await page.goto(`${url}${hash}`); await page.waitForSelector(ready, { timeout: 20000 }); await settle(page); };

/** What stands beyond the edge of the panel beside a picture, or is cut off there. */
const beyond = (page) => page.evaluate(() => {
    const panel = document.querySelector(".tools, .side"), edge = panel.getBoundingClientRect().left + panel.clientWidth - parseFloat(getComputedStyle(panel).paddingRight);
    const over = [...panel.querySelectorAll("*")].filter((e) => !e.closest(".formula, svg") && e.getBoundingClientRect().right > edge + 1);
    const cut = [...panel.querySelectorAll(".formula")].filter((e) => e.scrollWidth > e.clientWidth + 1);
    return [...over, ...cut].map((e) => `${e.tagName} ${e.className} ${e.closest("label")?.innerText ?? ""}`);
});

/** All that a figure shows, as text: changes when the picture does. */
const seen = (page) => page.evaluate(() => {
    const flat = [...document.querySelectorAll(".picture, .readout, pre")].map((e) => e.innerHTML).join("");
    const depth = [...document.querySelectorAll("canvas")].map((c) => c.toDataURL()).join("");
    return flat + depth;
});
const refused = (page) => page.evaluate(() => [...document.querySelectorAll(".readout.refused, .toast.refused")].map((e) => e.textContent).join("; "));

async function drag(page, locator, dx, dy) {
    const box = await locator.boundingBox();
    const x = box.x + box.width / 2, y = box.y + box.height / 2;
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + dx / 2, y + dy / 2);
    await page.mouse.move(x + dx, y + dy);
    await page.mouse.up();
    await settle(page);
}

const points = (page) => page.evaluate(async () => {
    const base = await new Promise((done) => { const r = indexedDB.open("freiform", 1); r.onsuccess = () => done(r.result); });
    return new Promise((done) => { const r = base.transaction("documents").objectStore("documents").get("now"); r.onsuccess = () => { base.close(); done(JSON.parse(r.result)); }; });
});
const toast = async (page) => { await page.waitForSelector(".toast.refused", { timeout: 8000 }); return page.locator(".toast.refused").last().innerText(); };
const file = async (page, path) => { await page.locator('input[type="file"]').first().setInputFiles(path); await settle(page); };

/** What a file dragged from elsewhere and let go there does. */
async function drop(page, onto, name, content, others = {}) {
    const data = await page.evaluateHandle((files) => {
        const transfer = new DataTransfer();
        for (const [name, content] of Object.entries(files)) transfer.items.add(new File([content], name));
        return transfer;
    }, { ...others, [name]: content });
    await page.locator(onto).first().dispatchEvent("drop", { dataTransfer: data });
}

/** Files and folders of the disk, from outside of the page. */
async function dropFromDisk(page, x, y, files) {
    const session = await page.context().newCDPSession(page);
    for (const type of ["dragEnter", "dragOver", "drop"])
        await session.send("Input.dispatchDragEvent", { type, x, y, data: { items: [], files, dragOperationsMask: 1 } });
    await session.detach();
}

/** Which pixels of the picture in space are drawn: "1" or "0" for each. */
const ink = (page) => page.evaluate(() => {
    const from = document.querySelector(".view.space canvas"), to = document.createElement("canvas");
    to.width = from.width;
    to.height = from.height;
    const pen = to.getContext("2d");
    pen.drawImage(from, 0, 0);
    const { data } = pen.getImageData(0, 0, to.width, to.height);
    let all = "";
    for (let i = 3; i < data.length; i += 4) all += data[i] > 64 ? "1" : "0";
    return all;
});
/** How many pixels two pictures differ in, and how many are drawn. */
const differing = (a, b) => { let n = Math.abs(a.length - b.length); for (let i = 0; i < a.length; ++i) n += a[i] === b[i] ? 0 : 1; return n; };
const drawn = (a) => a.replaceAll("0", "").length;

/** A STEP file of one circle and no faces. */
const ring = (radius) => `ISO-10303-21;
HEADER; FILE_DESCRIPTION((''),'2;1'); FILE_NAME('A','',(''),(''),'','',''); FILE_SCHEMA(('AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }')); ENDSEC;
DATA;
#1=CARTESIAN_POINT('',(0.,0.,0.)); #2=DIRECTION('',(0.,0.,1.)); #3=DIRECTION('',(1.,0.,0.)); #4=AXIS2_PLACEMENT_3D('',#1,#2,#3); #5=CIRCLE('',#4,${radius});
#6=APPLICATION_CONTEXT('managed model based 3d engineering'); #8=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.)); #9=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));
#10=(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT()); #11=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-09),#8,'distance_accuracy_value','');
#12=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#11))GLOBAL_UNIT_ASSIGNED_CONTEXT((#8,#9,#10))REPRESENTATION_CONTEXT('',''));
#13=GEOMETRIC_CURVE_SET('',(#5)); #14=GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION('',(#13),#12);
#15=PRODUCT_CONTEXT('',#6,'mechanical'); #16=PRODUCT('A','A','',(#15)); #18=PRODUCT_DEFINITION_CONTEXT('part definition',#6,'design');
#19=PRODUCT_DEFINITION_FORMATION('','',#16); #20=PRODUCT_DEFINITION('design','',#19,#18); #21=PRODUCT_DEFINITION_SHAPE('','',#20); #22=SHAPE_DEFINITION_REPRESENTATION(#21,#14);
ENDSEC;
END-ISO-10303-21;
`;

async function axe(page) {
    await page.evaluate(readFileSync(fileURLToPath(new URL("../../node_modules/axe-core/axe.min.js", import.meta.url)), "utf8"));
    const found = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
    assert.deepEqual(found.violations.map((v) => `${v.id}: ${v.nodes[0]?.html.slice(0, 120)}`), []);
}

const explore = kRows.map((row) => [`explore ${row}: draws, follows a handle or knob, by mouse and keyboard`, async ({ page, url, picture }) => {
    await page.evaluate(() => document.querySelector("article")?.remove()).catch(() => undefined);
    await go(page, url, `#/explore/${row}`, ".page .side h1");
    await until(page, () => document.querySelector(".picture *, canvas"));
    await settle(page);
    assert.equal(await refused(page), "");
    await picture(row);
    assert.deepEqual(await beyond(page), []);
    const before = await seen(page);
    const handle = page.locator(".handle").first();
    if (await handle.count() > 0) {
        await drag(page, handle, 14, -18);
        assert.equal(await refused(page), "");
        const dragged = await seen(page);
        assert.notEqual(dragged, before, "dragging a handle changes the picture");
        await handle.focus();
        await page.keyboard.press("ArrowLeft");
        await settle(page);
        assert.notEqual(await seen(page), dragged, "an arrow key changes the picture");
    }
    const slider = page.locator('.side input[type="range"]').first();
    if (await slider.count() > 0) {
        const was = await seen(page);
        await slider.focus();
        for (let i = 0; i < 6; ++i) await page.keyboard.press("ArrowRight");
        await settle(page);
        assert.notEqual(await seen(page), was, "a slider changes the picture");
    }
    for (const button of await page.locator(".side .choice button").all()) {
        await button.click();
        await settle(page);
        assert.equal(await refused(page), "", await button.innerText());
    }
    assert.equal(await refused(page), "");
}, { common: true }]);

export const cases = [
    ["overview: every row has a tile; no accessibility violations", async ({ page, url, picture }) => {
        await go(page, url, "", ".tiles");
        assert.equal(await page.locator(".tile").count(), kRows.length);
        await picture("overview");
        await axe(page);
    }],
    ...explore,
    ["language and theme change the page and stay", async ({ page, url, picture }) => {
        await go(page, url, "#/explore/R15", ".page h1");
        await page.getByRole("button", { name: "Deutsch" }).click();
        await page.waitForSelector("text=Im Editor öffnen");
        await page.getByRole("button", { name: "Hell oder dunkel" }).click();
        await settle(page);
        const theme = await page.evaluate(() => document.documentElement.dataset.theme);
        await picture("german-dark");
        await page.reload();
        await page.waitForSelector("text=Im Editor öffnen");
        assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), theme);
        assert.equal(await page.evaluate(() => document.documentElement.lang), "de");
        await axe(page);
    }],
    ["open in editor takes the curve along", async ({ page, url }) => {
        await go(page, url, "#/explore/R12", ".page h1");
        await page.getByRole("button", { name: "Open in editor" }).click();
        await page.waitForSelector(".tools .list li");
        assert.equal(await page.locator(".handle[aria-label*='point']").count(), 7);
    }],
    ["edit: create, drag, undo, redo, save, reload, open", async ({ page, url, write, read, picture }) => {
        await go(page, url, "#/edit", ".bar");
        await page.getByRole("button", { name: "New" }).click();
        await page.keyboard.press("b");
        const box = await page.locator("svg.plane").first().boundingBox();
        for (const [x, y] of [[0.2, 0.7], [0.35, 0.2], [0.55, 0.3], [0.7, 0.75], [0.85, 0.4]]) await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
        await page.keyboard.press("Enter");
        await settle(page);
        assert.equal(await page.locator(".handle[aria-label*='point']").count(), 5);
        const made = await points(page);
        assert.equal(made.objects[0].degree, 3);
        await drag(page, page.locator(".handle[aria-label*='point']").nth(2), 60, -40);
        const moved = await points(page);
        assert.notDeepEqual(moved.objects[0].points[2], made.objects[0].points[2]);
        assert.deepEqual(moved.objects[0].points[1], made.objects[0].points[1]);
        await picture("edit");
        await page.keyboard.press("Control+z");
        assert.deepEqual((await points(page)).objects[0].points, made.objects[0].points, "a drag is one step back");
        await page.keyboard.press("Control+Shift+z");
        assert.deepEqual((await points(page)).objects[0].points, moved.objects[0].points);
        const saving = page.waitForEvent("download");
        await page.keyboard.press("Control+s");
        const saved = read(await (await saving).path()).toString();
        assert.deepEqual(JSON.parse(saved).objects[0].points, moved.objects[0].points);
        await page.reload();
        await until(page, () => document.querySelectorAll(".handle[aria-label*='point']").length === 5);
        assert.deepEqual((await points(page)).objects[0].points, moved.objects[0].points, "autosave outlives a reload");
        await page.getByRole("button", { name: "New" }).click();
        await file(page, write("saved.json", saved));
        await until(page, () => document.querySelectorAll(".handle[aria-label*='point']").length === 5);
        assert.deepEqual((await points(page)).objects[0].points, moved.objects[0].points, "opened as it was saved");
        await axe(page);
    }],
    ["edit: a crash of the page loses nothing", async ({ page, context, url }) => {
        await go(page, url, "#/edit", ".bar");
        await drag(page, page.locator(".handle[aria-label*='point']").nth(1), 30, 20);
        const before = await points(page), places = (on) => on.evaluate(() => [...document.querySelectorAll(".handle")].map((e) => e.getAttribute("aria-valuetext")).join(";"));
        const shown = await places(page);
        page.goto("chrome://crash").catch(() => undefined);
        await new Promise((done) => setTimeout(done, 600));
        const again = await context.newPage();
        await go(again, url, "#/edit", ".handle");
        assert.deepEqual(await points(again), before);
        for (let i = 0; i < 40 && (await places(again)) !== shown; ++i) await new Promise((done) => setTimeout(done, 50));
        assert.equal(await places(again), shown, "what is shown is what was kept");
        await again.close();
    }],
    ["edit: by keyboard alone", async ({ page, url }) => {
        await go(page, url, "#/edit", ".handle");
        for (let i = 0; i < 60; ++i) {
            await page.keyboard.press("Tab");
            if (await page.evaluate(() => document.activeElement?.classList.contains("handle"))) break;
        }
        const name = await page.evaluate(() => document.activeElement.getAttribute("aria-label"));
        assert.match(name, /point 0/);
        await page.keyboard.press("ArrowUp");
        await page.keyboard.press("ArrowUp");
        await settle(page);
        const once = await points(page);
        assert.ok(once.objects[0].points[0][1] > 0);
        assert.match(await page.evaluate(() => document.activeElement.getAttribute("aria-label")), /point 0/, "focus stays");
        await page.keyboard.press("Enter");
        await page.keyboard.press("g");
        await page.waitForSelector("dialog input");
        await page.keyboard.type("1 2");
        await page.keyboard.press("Enter");
        await settle(page);
        const [x, y] = (await points(page)).objects[0].points[0];
        assert.ok(Math.abs(x - once.objects[0].points[0][0] - 1) < 1e-9 && Math.abs(y - once.objects[0].points[0][1] - 2) < 1e-9);
        await page.keyboard.press("Control+z");
        await page.keyboard.press("Control+z");
        await page.keyboard.press("Control+z");
        await settle(page);
        assert.deepEqual((await points(page)).objects[0].points[0], [0, 0]);
        await page.keyboard.press("Control+a");
        await page.keyboard.press("Control+d");
        await settle(page);
        assert.equal((await points(page)).objects.length, 2);
        await page.keyboard.press("Delete");
        await settle(page);
        assert.equal((await points(page)).objects.length, 1);
    }],
    ["edit: knots, degree, split, join, reverse keep the curve; weights change it", async ({ page, url }) => {
        await go(page, url, "#/edit", ".handle");
        const press = async (name) => { await page.getByRole("button", { name, exact: true }).click(); await settle(page); assert.equal(await refused(page), "", name); };
        await page.locator(".tools .list button").first().click();
        await press("Insert knot");
        assert.equal((await points(page)).objects[0].points.length, 6);
        await press("Elevate");
        assert.equal((await points(page)).objects[0].degree, 4);
        await press("Remove knots");
        await press("Reverse");
        await press("Split");
        assert.equal((await points(page)).objects.length, 2);
        await page.locator(".tools .list button").nth(0).click();
        await page.locator(".tools .list button").nth(1).click({ modifiers: ["Shift"] });
        await press("Join");
        const joined = await points(page);
        assert.equal(joined.objects.length, 1);
        await page.locator(".handle[aria-label*='point']").nth(1).focus();
        await page.keyboard.press("Enter");
        await page.getByLabel("weight").fill("3");
        await page.getByLabel("weight").press("Enter");
        await settle(page);
        assert.equal((await points(page)).objects[0].weights[1], 3);
    }],
    ["edit: revolve and extrude make surfaces; exports are what they say", async ({ page, url, read, picture }) => {
        await go(page, url, "#/edit", ".handle");
        await page.locator(".tools .list button").first().click();
        await page.getByRole("button", { name: "Revolve" }).click();
        await page.waitForSelector(".view.space canvas");
        await settle(page);
        assert.equal(await refused(page), "");
        assert.deepEqual((await points(page)).objects.map((o) => o.type), ["curve", "surface"]);
        await picture("revolved");
        const head = { svg: "<?xml", png: "\x89PNG", glb: "glTF", stl: "", step: "ISO-10303-21" };
        for (const [format, start] of Object.entries(head)) {
            const saving = page.waitForEvent("download");
            await page.getByLabel("Export as").selectOption(format);
            const bytes = read(await (await saving).path());
            assert.ok(bytes.length > 80, format);
            assert.equal(bytes.subarray(0, start.length).toString("latin1"), start, format);
            if (format === "stl") assert.equal(bytes.length, 84 + 50 * bytes.readUInt32LE(80));
        }
    }],
    ["edit: loft and Coons", async ({ page, url, write }) => {
        const z = (h, s) => [[0, 0, h], [1 * s, 1, h], [2, 1, h], [3, 0, h]];
        await go(page, url, "#/edit", ".handle");
        await file(page, write("loft.json", JSON.stringify({ freiform: 1, objects: [0, 1, 2].map((h) => ({ type: "curve", points: z(h, 1 + h) })) })));
        await page.keyboard.press("Control+a");
        await page.getByRole("button", { name: "Loft" }).click();
        await settle(page);
        assert.equal(await refused(page), "");
        assert.equal((await points(page)).objects.length, 4);
        const side = (p) => ({ type: "curve", points: p });
        await file(page, write("coons.json", JSON.stringify({ freiform: 1, objects: [side([[0, 0, 0], [1, 0, 1], [2, 0, 0]]), side([[2, 2, 0], [2, 1, 1], [2, 0, 0]]), side([[0, 2, 0], [1, 2, 1], [2, 2, 0]]), side([[0, 0, 0], [0, 1, -1], [0, 2, 0]])] })));
        await page.keyboard.press("Control+a");
        await page.getByRole("button", { name: "Coons (four curves)" }).click();
        await settle(page);
        assert.equal(await refused(page), "");
        const made = (await points(page)).objects[4];
        assert.equal(made.type, "surface");
    }],
    ["edit: in space the gizmo moves, turns and scales what is chosen, by mouse and keyboard, in both languages", async ({ page, url, write, picture }) => {
        const net = [0, 1, 2].map((i) => [0, 1, 2].map((j) => [i, j, i === 1 && j === 1 ? 1.5 : 0]));
        await go(page, url, "#/edit", ".handle");
        await file(page, write("net.json", JSON.stringify({ freiform: 1, objects: [{ type: "surface", name: "net", points: net }] })));
        await page.waitForSelector(".view.space canvas");
        const part = (name) => page.locator(`.parts .handle[aria-label="${name}"]`), parts = page.locator(".parts .handle");
        const now = async () => (await points(page)).objects[0].points.flat();
        const middle = async (name) => { const box = await part(name).locator(":nth-child(2)").first().boundingBox(); return [box.x + box.width / 2, box.y + box.height / 2]; };
        const apart = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));
        const close = (a, b, within = 1e-9) => assert.ok(Math.abs(a - b) <= within, `${a} is not ${b}`);
        assert.equal(await parts.count(), 0, "nothing is chosen");
        await page.keyboard.press("Control+a");
        await settle(page);
        assert.equal(await parts.count(), 11);
        await picture("gizmo");
        await axe(page);

        // Along an axis: that coordinate of all points alone, and what is held stays under the cursor.
        await page.getByLabel("Snap").uncheck();
        const [cx, cy] = await middle("move, freely"), [ax, ay] = await middle("move, axis x"), far = Math.hypot(ax - cx, ay - cy);
        const first = await now();
        await drag(page, part("move, axis x"), (70 * (ax - cx)) / far, (70 * (ay - cy)) / far);
        const right = await now(), dx = right[0][0] - first[0][0];
        assert.ok(dx > 0.05, `moved by ${dx}`);
        right.forEach((p, i) => { close(p[0] - first[i][0], dx); assert.deepEqual(p.slice(1), first[i].slice(1)); });
        const [bx, by] = await middle("move, axis x");
        close(bx, ax + (70 * (ax - cx)) / far, 8);
        close(by, ay + (70 * (ay - cy)) / far, 8);
        await page.keyboard.press("Control+z");
        assert.deepEqual(await now(), first, "a drag is one step back");

        // A turn keeps distances, heights and the middle; with snapping it is by multiples of 5 degrees.
        await page.getByLabel("Snap").check();
        await drag(page, part("turn, axis z"), 40, -12);
        const turned = await now();
        turned.forEach((p, i) => { close(apart(p, turned[4]), apart(first[i], first[4])); close(p[2], first[i][2]); });
        const angle = (Math.atan2(turned[3][1] - turned[0][1], turned[3][0] - turned[0][0]) * 180) / Math.PI;
        assert.ok(Math.abs(angle) > 1);
        close(angle / 5, Math.round(angle / 5));
        close(turned.reduce((sum, p) => sum + p[0], 0) / 9, 1);
        await page.keyboard.press("Control+z");
        assert.deepEqual(await now(), first);

        // A box scales one axis, the square all three.
        const [sx, sy] = await middle("scale, axis y"), [mx, my] = await middle("move, freely");
        await drag(page, part("scale, axis y"), 0.5 * (sx - mx), 0.5 * (sy - my));
        const wide = await now(), k = (wide[2][1] - wide[0][1]) / 2;
        assert.ok(k > 1.2 && k < 2, `scaled by ${k}`);
        wide.forEach((p, i) => { close(p[0], first[i][0]); close(p[1], 1 + k * (first[i][1] - 1)); close(p[2], first[i][2]); });
        await page.keyboard.press("Control+z");
        await drag(page, part("scale, as a whole"), -20, 20);
        const large = await now(), all = (large[2][1] - large[0][1]) / 2;
        assert.ok(all > 1.1);
        large.forEach((p, i) => { close(apart(p, large[0]), all * apart(first[i], first[0])); });
        await page.keyboard.press("Control+z");

        // By keyboard: a degree, ten with Shift; a round length.
        await part("turn, axis z").focus();
        await page.keyboard.press("ArrowRight");
        await page.keyboard.press("Shift+ArrowUp");
        await settle(page);
        const keyed = await now();
        close((Math.atan2(keyed[3][1] - keyed[0][1], keyed[3][0] - keyed[0][0]) * 180) / Math.PI, 11);
        assert.equal(await page.evaluate(() => document.activeElement.getAttribute("aria-label")), "turn, axis z", "focus stays");
        await page.keyboard.press("Control+z");
        await page.keyboard.press("Control+z");
        await part("move, axis z").focus();
        await page.keyboard.press("ArrowUp");
        await settle(page);
        const lifted = (await now())[0][2];
        assert.ok(lifted > 0 && /^[125]0*$/.test(lifted.toString().replace("0.", "").replace(/^0+/, "")), `lifted by ${lifted}`);
        await page.keyboard.press("Control+z");
        assert.deepEqual(await now(), first);

        // One point is moved and nothing else; T takes the gizmo away.
        await page.keyboard.press("Escape");
        await page.locator(".handle[aria-label*='point 4']").focus();
        await page.keyboard.press("Enter");
        assert.equal(await parts.count(), 3);
        await page.keyboard.press("t");
        await settle(page);
        assert.equal(await parts.count(), 0);
        await page.getByRole("button", { name: "Deutsch" }).click();
        await until(page, () => document.querySelectorAll(".handle[aria-label*='Punkt']").length === 9);
        await page.keyboard.press("Control+a");
        await settle(page);
        assert.equal(await part("Drehen, Achse z").count(), 1);
        assert.equal(await part("Vergrößern, ganz").count(), 1);
        await page.getByRole("button", { name: "Hell oder dunkel" }).click();
        await settle(page);
        await picture("gizmo-german-dark");
        assert.equal(await refused(page), "");
    }],
    ["edit: what Explore hands over is one more step: undo leads back to the drawing, also after a reload", async ({ page, url }) => {
        await go(page, url, "#/edit", ".handle");
        await drag(page, page.locator(".handle[aria-label*='point']").nth(1), 30, 20);
        const mine = (await points(page)).objects;
        await page.reload();
        await page.waitForSelector(".handle");
        await go(page, url, "#/explore/R12", ".page h1");
        await page.getByRole("button", { name: "Open in editor" }).click();
        await until(page, () => document.querySelectorAll(".handle[aria-label*='point']").length === 7);
        await until(page, () => !document.querySelector("button[title^='Ctrl+Z']").disabled);
        await new Promise((done) => setTimeout(done, 300));
        await page.keyboard.press("Control+z");
        await settle(page);
        assert.deepEqual((await points(page)).objects, mine, "what was drawn before");
        await page.keyboard.press("Control+Shift+z");
        await settle(page);
        assert.equal((await points(page)).objects[0].points.length, 7);
    }],
    ["edit: while the pen is under way, undo, redo and the keys that delete are of its points", async ({ page, url }) => {
        await go(page, url, "#/edit", ".handle");
        const objects = () => page.locator(".tools .list li").count(), dots = () => page.evaluate(() => (document.querySelector(".stage .picture path[stroke-width='8']")?.getAttribute("d") ?? "").split("M").length - 1);
        const click = async (...places) => { for (const [x, y] of places) await page.mouse.click(box.x + x * box.width, box.y + y * box.height); await settle(page); };
        const press = async (key) => { await page.keyboard.press(key); await settle(page); };
        const box = await page.locator("svg.plane").first().boundingBox();
        await page.locator(".tools .list button").first().click();
        await page.evaluate(() => document.activeElement.blur());
        await press("b");
        await click([0.05, 0.1], [0.1, 0.2], [0.2, 0.1]);
        assert.equal(await dots(), 3);
        for (const [key, left] of [["Backspace", 2], ["Control+z", 1], ["Control+Shift+z", 2], ["Delete", 1], ["Control+y", 2], ["x", 1]]) {
            await press(key);
            assert.equal(await dots(), left, key);
            assert.equal(await objects(), 1, `${key} leaves the drawing alone`);
        }
        for (let i = 0; i < 3; ++i) await press("Control+z");
        await press("Delete");
        assert.equal(await objects(), 1);
        assert.equal(await dots(), 0);
        await click([0.05, 0.1], [0.1, 0.2]);
        await page.getByRole("button", { name: "Undo" }).click();
        await settle(page);
        assert.equal(await dots(), 1, "the button, too");
        await click([0.2, 0.1]);
        await page.evaluate(() => document.activeElement.blur());
        await press("Enter");
        assert.equal(await objects(), 2);
        assert.equal((await points(page)).objects[1].points.length, 2);
        await press("Control+z");
        assert.equal(await objects(), 1, "the pen is put away: the drawing is meant again");
    }],
    ["edit: windows do not overwrite each other's drawing; what was closed comes back, one by one", async ({ page, context, url }) => {
        const places = (on) => on.evaluate(() => [...document.querySelectorAll(".stage .handle")].map((e) => e.getAttribute("aria-valuetext")).join(";"));
        const becomes = async (on, what, why) => { for (let i = 0; i < 60 && (await places(on)) !== what; ++i) await new Promise((done) => setTimeout(done, 50)); assert.equal(await places(on), what, why); };
        await go(page, url, "#/edit", ".handle");
        const two = await context.newPage();
        await go(two, url, "#/edit", ".handle");
        await page.bringToFront();
        await drag(page, page.locator(".handle[aria-label*='point']").nth(1), 30, 20);
        const first = await places(page);
        await two.bringToFront();
        await drag(two, two.locator(".handle[aria-label*='point']").nth(3), -40, 30);
        const second = await places(two);
        assert.notEqual(first, second);
        for (const [on, what] of [[page, first], [two, second]]) {
            await on.bringToFront();
            await on.reload();
            await on.waitForSelector(".handle");
            await becomes(on, what, "after a reload");
        }
        const three = await context.newPage();
        await go(three, url, "#/edit", ".handle");
        await becomes(three, second, "a window more begins with the newest drawing");
        await drag(three, three.locator(".handle[aria-label*='point']").nth(2), 20, 30);
        const third = await places(three);
        await page.reload();
        await page.waitForSelector(".handle");
        await becomes(page, first, "and writes it elsewhere");
        await page.close();
        await three.close();
        for (const what of [third, first]) {
            const again = await context.newPage();
            await go(again, url, "#/edit", ".handle");
            await becomes(again, what, "the newest of the closed");
        }
        await two.close();
    }],
    ["edit: what is deleted or taken back during a drag lets go of the hand, with the gizmo, too", async ({ page, url, write }) => {
        const line = (name, x) => ({ type: "curve", name, points: [[x, 0], [x + 1, 1]] });
        const at = (locator) => locator.evaluate((e) => { const b = e.children[1].getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; });
        const steps = async () => { let n = 0; while (await page.isEnabled("button[title^='Ctrl+Z']")) { await page.keyboard.press("Control+z"); ++n; } return n; };
        const through = async (locator, key, dx, dy) => {
            const [x, y] = await at(locator);
            await page.mouse.move(x, y);
            await page.mouse.down();
            for (let i = 1; i <= 4; ++i) await page.mouse.move(x + (i * dx) / 8, y + (i * dy) / 8);
            await page.keyboard.press(key);
            for (let i = 5; i <= 8; ++i) await page.mouse.move(x + (i * dx) / 8, y + (i * dy) / 8);
            await page.mouse.up();
            await settle(page);
        };
        await go(page, url, "#/edit", ".handle");
        await file(page, write("abc.json", JSON.stringify({ freiform: 1, objects: [line("A", 0), line("B", 2), line("C", 4)] })));
        await through(page.locator(".handle[aria-label='A, point 0']"), "Delete", 80, -60);
        assert.deepEqual((await points(page)).objects.map((o) => [o.name, o.points[0]]), [["B", [2, 0]], ["C", [4, 0]]], "B stays where it is");
        await through(page.locator(".handle[aria-label='B, point 1']"), "Control+z", 80, -60);
        assert.deepEqual((await points(page)).objects[0].points, [[2, 0], [3, 1]]);
        assert.equal(await steps(), 3, "what was taken back leaves no steps behind: open, drag, delete");

        const net = [0, 1, 2].map((i) => [0, 1, 2].map((j) => [i, j, 0]));
        await file(page, write("net.json", JSON.stringify({ freiform: 1, objects: [{ type: "surface", name: "net", points: net }] })));
        await page.waitForSelector(".view.space canvas");
        await page.keyboard.press("Control+a");
        await settle(page);
        await through(page.locator(".parts .handle[aria-label='move, freely']"), "Control+z", 60, 40);
        assert.deepEqual((await points(page)).objects[0].points, net);
        assert.equal(await page.locator(".status").textContent().then((s) => /move, freely/.test(s)), false);
        assert.equal(await steps(), 1, "open");
    }],
    ["edit: what is chosen stays chosen when others come and go by undo", async ({ page, url, write }) => {
        const line = (name, x) => ({ type: "curve", name, points: [[x, 0], [x + 1, 1]] });
        const list = () => page.locator(".tools .list button").evaluateAll((l) => l.map((b) => (b.getAttribute("aria-pressed") === "true" ? "*" : "") + b.textContent[0]).join(" "));
        await go(page, url, "#/edit", ".handle");
        await file(page, write("abc.json", JSON.stringify({ freiform: 1, objects: [line("A", 0), line("B", 2), line("C", 4)] })));
        await page.locator(".tools .list button").nth(0).click();
        await page.keyboard.press("Delete");
        await page.locator(".tools .list button").nth(0).click();
        await page.locator(".handle[aria-label='B, point 1']").focus();
        await page.keyboard.press("Enter");
        await settle(page);
        assert.equal(await list(), "*B C");
        await page.keyboard.press("Control+z");
        await settle(page);
        assert.equal(await list(), "A *B C");
        assert.equal(await page.locator(".handle.chosen").getAttribute("aria-label"), "B, point 1");
        await page.keyboard.press("Control+z");
        await settle(page);
        assert.equal(await page.locator(".tools .list button[aria-pressed='true']").count(), 0, "what is gone is not chosen");
        await page.keyboard.press("Control+Shift+z");
        await page.keyboard.press("Control+Shift+z");
        await page.locator(".tools .list button").nth(1).click();
        await page.keyboard.press("Delete");
        await settle(page);
        assert.equal(await list(), "B");
    }],
    ["edit: models are shown and exported within a tolerance of their size", async ({ page, url, read, picture }) => {
        await go(page, url, "#/inspect", ".stage");
        await drop(page, ".stage", "bracket.step", bracket());
        await until(page, () => document.querySelector(".tools .list li, .readout tr") && document.querySelector("progress").hidden);
        await page.locator(".bar").getByRole("button", { name: "Edit" }).click();
        await page.getByLabel("Export as").waitFor();
        await page.getByRole("button", { name: "Fit" }).click();
        await settle(page);
        const saving = page.waitForEvent("download");
        await page.getByLabel("Export as").selectOption("stl");
        const triangles = read(await (await saving).path()).readUInt32LE(80);
        assert.ok(triangles > 2000 && triangles < 10000, `${triangles} triangles; within 0.001 they would be 174008`);
        await picture("edit-model");
        assert.equal(await refused(page), "");
    }],
    ["edit: curves that do not end at their outer points are joined where they end; closed ones are refused", async ({ page, url, write }) => {
        const open = async (...objects) => { await file(page, write("join.json", JSON.stringify({ freiform: 1, objects }))); await page.evaluate(() => document.activeElement.blur()); await page.keyboard.press("Escape"); await page.keyboard.press("j"); await settle(page); };
        const close = (a, b) => { assert.equal(a.length, b.length); a.forEach((p, i) => { assert.ok(Math.hypot(p[0] - b[i][0], p[1] - b[i][1]) < 1e-9, `${a} is not ${b}`); }); };
        const v = { type: "curve", name: "V", points: [[0, 0], [1, 2], [3, 1]] }, u = { type: "curve", name: "U", degree: 2, knots: [0, 1, 2, 3, 4, 5, 6], points: [[3, 1], [4, -1], [6, 0], [7, 3]] };
        await go(page, url, "#/edit", ".handle");
        await open(v, u);
        assert.match(await toast(page), /1\.118/, "U begins at 3.5, 0");
        assert.equal((await points(page)).objects.length, 2);
        await page.locator(".toast .close").click();
        await open({ ...v, points: [[0, 0], [1, 2], [3.5, 0]] }, u);
        assert.equal(await refused(page), "");
        const [one, ...others] = (await points(page)).objects;
        assert.equal(others.length, 0);
        // The curve that U is: quadratic pieces between 3.5, 0 and 6.5, 1.5.
        close(one.points, [[0, 0], [1, 2], [3.5, 0], [4, -1], [6, 0], [6.5, 1.5]]);
        assert.deepEqual(one.knots, [0, 0, 0, 1, 1, 2, 3, 3, 3]);
        await open(v, { type: "curve", name: "Ring", closed: true, degree: 2, knots: [0, 1, 2, 3, 4], points: [[3, 1], [5, 1], [5, 3], [3, 3]] });
        assert.match(await toast(page), /Ring/);
        assert.equal((await points(page)).objects.length, 2);
    }],
    ["edit: what a file holds and the drawing does not, and what a file cannot hold, is told", async ({ page, url, write, picture }) => {
        await go(page, url, "#/edit", ".handle");
        await file(page, write("left.svg", '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><text x="1" y="9">hi</text><path d="M0 0 L10 10"/><path d="M0 0 L"/></svg>'));
        await page.waitForSelector(".toast");
        const told = await page.locator(".toast").allInnerTexts().then((l) => l.join(" "));
        await picture("left-out");
        assert.match(told, /text has no outlines/);
        assert.match(told, /found the end/);
        assert.equal((await points(page)).objects.length, 1);
        while (await page.locator(".toast .close").count() > 0) await page.locator(".toast .close").first().click();
        const net = [0, 1, 2].map((i) => [0, 1, 2].map((j) => [i, j, i === 1 && j === 1 ? 2 : 0]));
        await file(page, write("mix.json", JSON.stringify({ freiform: 1, objects: [{ type: "surface", name: "S", points: net }, { type: "curve", name: "Edge", points: [[1, 0, 0], [2, 1, 0], [1, 3, 0]] }] })));
        assert.equal(await refused(page), "");
        for (const format of ["glb", "stl"]) {
            const saving = page.waitForEvent("download");
            await page.getByLabel("Export as").selectOption(format);
            await saving;
            assert.match(await toast(page), /"Edge".*a curve has no faces/s, format);
            await page.locator(".toast .close").first().click();
        }
        const saving = page.waitForEvent("download");
        await page.getByLabel("Export as").selectOption("step");
        await saving;
        assert.equal(await refused(page), "", "STEP holds both");
    }],
    ["edit: one knot is edited and the others keep their last bit", async ({ page, url, write }) => {
        await go(page, url, "#/edit", ".handle");
        await file(page, write("k.json", JSON.stringify({ freiform: 1, objects: [{ type: "curve", name: "K", degree: 2, knots: [0, 0, 0, 1 / 3, 2 / 3, 1, 1, 1], points: [[0, 0], [1, 1], [2, 0], [3, 1], [4, 0]] }] })));
        await page.locator(".tools .list button").click();
        const knots = page.getByRole("textbox", { name: "Knots" });
        await knots.fill((await knots.inputValue()).replace(/1 1 1$/, "2 2 2"));
        await knots.press("Enter");
        await settle(page);
        assert.deepEqual((await points(page)).objects[0].knots, [0, 0, 0, 1 / 3, 2 / 3, 2, 2, 2]);
        await knots.fill("0 0 0 abc 1 2 2 2");
        await knots.press("Enter");
        assert.match(await toast(page), /abc/);
        assert.deepEqual((await points(page)).objects[0].knots, [0, 0, 0, 1 / 3, 2 / 3, 2, 2, 2]);
    }],
    ["edit: what is no number is refused aloud; a comma that may be two things is asked about", async ({ page, url, write, picture }) => {
        const press = async (...keys) => { for (const key of keys) await page.keyboard.press(key); await settle(page); };
        const blur = () => page.evaluate(() => document.activeElement.blur());
        await go(page, url, "#/edit", ".handle");
        await file(page, write("w.json", JSON.stringify({ freiform: 1, objects: [{ type: "curve", name: "A", points: [[0, 0], [1, 2], [3, 1]] }] })));
        await page.locator(".tools .list button").click();
        await blur();
        const move = async (by) => { await press("g"); await page.locator("dialog input").fill(by); await press("Enter"); };
        await move("1.5, 2");
        assert.deepEqual((await points(page)).objects[0].points[0], [1.5, 2]);
        for (const what of ["1,5 2", "abc"]) {
            await move(what);
            assert.match(await page.locator("dialog [role=alert]").innerText(), new RegExp(what.split(" ")[0]));
            await picture("dialog-refused");
            await press("Escape");
            assert.deepEqual((await points(page)).objects[0].points[0], [1.5, 2]);
        }
        await move("abc");
        await page.locator("dialog input").fill("-1.5 -2");
        await press("Enter");
        assert.deepEqual((await points(page)).objects[0].points[0], [0, 0], "it may be mended there");
        await page.getByLabel("at parameter").fill("0,25");
        await page.getByRole("button", { name: "Insert knot" }).click();
        await settle(page);
        assert.equal((await points(page)).objects[0].knots[3], 0.25);
        await page.getByLabel("at parameter").fill("half");
        await page.getByRole("button", { name: "Insert knot" }).click();
        assert.match(await toast(page), /half/);
        assert.equal((await points(page)).objects[0].points.length, 4);
    }],
    ["edit: focus stays where it is when a step changes the panel", async ({ page, url }) => {
        const active = () => page.evaluate(() => { const e = document.activeElement; return `${e.tagName} ${e.getAttribute("aria-label") ?? e.textContent}`; });
        await go(page, url, "#/edit", ".handle");
        await page.locator(".tools .list button").first().focus();
        await page.keyboard.press("Enter");
        await settle(page);
        assert.match(await active(), /^BUTTON curve/);
        await page.locator(".tools .handle").first().focus();
        const knot = async () => (await points(page)).objects[0].knots[4];
        await page.keyboard.press("ArrowRight");
        await settle(page);
        const once = await knot();
        await page.keyboard.press("ArrowRight");
        await settle(page);
        assert.ok(await knot() > once, "the second arrow moves it, too");
        await page.locator(".stage .handle").nth(1).focus();
        await page.keyboard.press("Enter");
        const field = (name) => page.locator(`.tools input[aria-label="${name}"]`);
        await field("x").focus();
        for (const x of ["2", "3"]) { await page.keyboard.press("ArrowUp"); await settle(page); assert.equal(await field("x").inputValue(), x); }
        await field("y").fill("2");
        await page.keyboard.press("Enter");
        await settle(page);
        assert.equal(await active(), "INPUT y");
        assert.deepEqual((await points(page)).objects[0].points[1], [3, 2]);
        const knots = page.getByRole("textbox", { name: "Knots" });
        await knots.fill((await knots.inputValue()).replace(/^0 0 0 0/, "-1 -1 -1 -1"));
        await knots.press("Enter");
        await settle(page);
        assert.equal(await active(), "INPUT Knots");
        await page.getByLabel("weight").focus();
        await page.getByLabel("weight").fill("2");
        await page.keyboard.press("Tab");
        await settle(page);
        assert.equal(await active(), "INPUT Knots", "Tab goes on from there");
        await page.evaluate(() => document.activeElement.blur());
        await page.keyboard.press("Escape");
        await settle(page);
        assert.equal(await knots.isVisible(), false);
    }],
    ["edit: undo and what was copied outlive a visit to another part and a change of language", async ({ page, url }) => {
        await go(page, url, "#/edit", ".handle");
        await page.locator(".tools .list button").first().click();
        await page.getByRole("button", { name: "Elevate" }).click();
        await page.evaluate(() => document.activeElement.blur());
        await page.keyboard.press("Control+c");
        for (const part of ["Inspect", "Explore", "Edit"]) { await page.locator("nav").getByText(part).click(); await settle(page); }
        await page.waitForSelector(".stage .handle");
        await page.getByRole("button", { name: "Deutsch" }).click();
        await settle(page);
        assert.equal(await page.locator(".tools .list button[aria-pressed='true']").count(), 1, "and what was chosen");
        await page.evaluate(() => document.activeElement.blur());
        await page.keyboard.press("Control+v");
        await settle(page);
        assert.equal((await points(page)).objects.length, 2);
        await page.keyboard.press("Control+z");
        await page.keyboard.press("Control+z");
        await settle(page);
        const { objects } = await points(page);
        assert.deepEqual([objects.length, objects[0].degree], [1, 3]);
        assert.equal(await page.locator(".toast.refused").count(), 0);
        // What is handed over later is one more step of the same history.
        await page.goto(`${url}#/explore/R12`);
        await page.getByRole("button", { name: "Im Editor öffnen" }).click();
        await until(page, () => document.querySelectorAll(".stage .handle").length === 7);
        await page.keyboard.press("Control+z");
        await settle(page);
        assert.deepEqual((await points(page)).objects, objects);
    }],
    ["edit: the pen sets a point on a point; Shift and Several choose a second curve", async ({ page, url, write, picture }) => {
        const line = (name, y) => ({ type: "curve", name, points: [[0, y], [6, y]] });
        const list = () => page.locator(".tools .list button").evaluateAll((l) => l.map((b) => (b.getAttribute("aria-pressed") === "true" ? "*" : "") + b.textContent.split(" ")[0]).join(" "));
        await go(page, url, "#/edit", ".handle");
        await file(page, write("two.json", JSON.stringify({ freiform: 1, objects: [line("A", 0), line("B", 2)] })));
        const spot = (name) => page.locator(`.handle[aria-label="${name}"]`).evaluate((e) => { const b = e.children[1].getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; });
        const [[x0, y0], [x1, y1], [, y2]] = [await spot("A, point 0"), await spot("A, point 1"), await spot("B, point 0")], mid = (x0 + x1) / 2;
        const list2 = async (...clicks) => { for (const y of clicks) await page.mouse.click(mid, y); await settle(page); return list(); };
        assert.equal(await list2(y1), "*A B");
        await page.keyboard.down("Shift");
        assert.equal(await list2(y2), "*A *B");
        assert.equal(await list2(y2), "*A B");
        await page.keyboard.up("Shift");
        await page.keyboard.press("Escape");
        await page.getByRole("button", { name: "Several" }).click();
        assert.equal(await list2(y1, y2), "*A *B");
        await page.mouse.move(x0 - 20, y0 + 20);
        await page.mouse.down();
        await page.mouse.move(mid, y1 - 20, { steps: 4 });
        await page.mouse.up();
        await settle(page);
        assert.equal(await page.locator(".stage .handle.chosen").count(), 1, "a frame still chooses points");
        await page.getByRole("button", { name: "Several" }).click();
        await page.evaluate(() => document.activeElement.blur());
        await page.keyboard.press("Escape");
        await page.keyboard.press("b");
        await page.mouse.click(x1 + 2, y1 + 1);
        await page.mouse.click(mid, (y1 + y2) / 2);
        await picture("pen-on-point");
        await page.mouse.click(x0, y0);
        await page.keyboard.press("Enter");
        await settle(page);
        const { points: made } = (await points(page)).objects[2];
        assert.deepEqual([made.length, made[0], made[2]], [3, [6, 0], [0, 0]], "from the end of A to its beginning");
    }],
    ["edit: in space a click and a frame choose; where the pen cannot draw, the status says so", async ({ page, url, write, picture }) => {
        const net = [0, 1, 2].map((i) => [0, 1, 2].map((j) => [i, j, i === 1 && j === 1 ? 1.5 : 0]));
        const list = () => page.locator(".tools .list button").evaluateAll((l) => l.map((b) => (b.getAttribute("aria-pressed") === "true" ? "*" : "") + b.textContent[0]).join(" "));
        await go(page, url, "#/edit", ".handle");
        await file(page, write("net.json", JSON.stringify({ freiform: 1, objects: [{ type: "surface", name: "S", points: net }, { type: "curve", name: "C", points: [[3, 0, 0], [3, 1, 1], [3, 2, 0]] }] })));
        await page.waitForSelector(".view.space canvas");
        await settle(page);
        const spot = async (name) => page.locator(`.handle[aria-label="${name}"]`).evaluate((e) => { const b = e.children[1].getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; });
        const [[ax, ay], [bx, by], [cx, cy], [dx, dy]] = [await spot("S, point 3"), await spot("S, point 4"), await spot("C, point 0"), await spot("C, point 1")];
        const click = async (x, y) => { await page.mouse.click(x, y); await settle(page); };
        await click(0.7 * ax + 0.3 * bx, 0.7 * ay + 0.3 * by);
        assert.equal(await list(), "*S C");
        // A parabola is halfway between its middle point and the middle of its ends.
        const [ex, ey] = await (async () => { await page.keyboard.press("Escape"); await settle(page); return spot("C, point 2"); })();
        const onC = [0.5 * dx + 0.25 * (cx + ex), 0.5 * dy + 0.25 * (cy + ey)];
        await page.keyboard.down("Shift");
        await click(...onC);
        await page.keyboard.up("Shift");
        assert.equal(await list(), "S *C");
        const box = await page.locator(".view.space canvas").boundingBox();
        await click(box.x + 6, box.y + box.height - 6);
        assert.equal(await list(), "S C", "a click beside everything chooses nothing");
        await page.keyboard.down("Shift");
        await page.mouse.move(box.x + 5, box.y + 5);
        await page.mouse.down();
        await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2, { steps: 3 });
        await picture("space-frame");
        await page.mouse.move(box.x + box.width - 5, box.y + box.height - 5, { steps: 3 });
        await page.mouse.up();
        await page.keyboard.up("Shift");
        await settle(page);
        assert.match(await page.locator(".status").textContent(), /12 points chosen/);
        assert.deepEqual(await spot("S, point 3"), [ax, ay], "the eye stays where it was");
        await page.keyboard.press("Escape");
        await page.keyboard.press("b");
        await settle(page);
        assert.match(await page.locator(".status").textContent(), /plane/);
        await click(box.x + 40, box.y + 40);
        await page.keyboard.press("Enter");
        assert.equal(await page.locator(".tools .list li").count(), 2);
    }],
    ["edit: small things: nothing to paste, a point to cut, many points, names", async ({ page, url, write }) => {
        const press = async (...keys) => { for (const key of keys) await page.keyboard.press(key); await settle(page); };
        const blur = () => page.evaluate(() => document.activeElement.blur());
        const chosen = () => page.locator(".tools .list button[aria-pressed='true']").count();
        await go(page, url, "#/edit", ".handle");
        await press("Control+v");
        assert.equal(await chosen(), 0, "nothing was copied: nothing is chosen");
        assert.match(await page.locator(".toast").innerText(), /Nothing/);
        assert.equal(await page.isEnabled("button[title^='Ctrl+Z']"), false);

        await page.locator(".stage .handle").nth(1).focus();
        await press("Enter", "Control+x");
        assert.equal(await page.locator(".tools .list li").count(), 0, "a point means its curve, as for Delete");
        await blur();
        await press("Control+v");
        assert.equal(await page.locator(".tools .list li").count(), 1);

        await file(page, write("two.json", JSON.stringify({ freiform: 1, objects: [{ type: "curve", points: [[1, 0], [2, 1]] }, { type: "curve", points: [[3, 0], [4, 1]] }] })));
        await blur();
        await press("Control+a");
        await page.getByRole("button", { name: "Revolve" }).click();
        await settle(page);
        const names = (await points(page)).objects.slice(2).map((o) => o.name);
        assert.equal(names.length, 2);
        assert.notEqual(names[0], names[1]);

        await file(page, write("long.json", JSON.stringify({ freiform: 1, objects: [{ type: "curve", name: "L", degree: 1, points: Array.from({ length: 700 }, (_, i) => [i, 40 * Math.sin(i / 20)]), knots: [0, ...Array.from({ length: 700 }, (_, i) => i), 699] }] })));
        await settle(page);
        assert.match(await page.locator(".status").textContent(), /0 of 700 points can be taken hold of: choose an object/);
        await page.locator(".tools .list button").click();
        await settle(page);
        assert.match(await page.locator(".status").textContent(), /600 of 700 points/);
        assert.equal(await page.locator(".stage .handle").count(), 600);
    }],
    ["edit: in German all words are German", async ({ page, url }) => {
        await go(page, url, "#/edit", ".handle");
        await page.locator(".tools .list button").first().click();
        const titles = [];
        for (const name of ["Grad erhöhen", "Umkehren", "Knoten einfügen", "Bézier-Stücke", "Drehen"]) {
            if (name === "Drehen") await page.locator(".tools .list button").first().click();
            await page.getByRole("button", { name, exact: true }).click();
            await settle(page);
            titles.push((await page.getAttribute("button[title^='Ctrl+Z'], button[title^='Strg+Z']", "title")).replace(/^\S+ /, ""));
        }
        assert.deepEqual(titles, ["Grad erhöhen", "Umkehren", "Knoten einfügen", "Bézier-Stücke", "Drehen"]);
        await page.getByRole("button", { name: "Tasten" }).click();
        const words = await page.locator("body").innerText();
        for (const word of ["Space", "drag", "arrows", "Ctrl", "Shift", "curve", "revolve", "elevate"]) assert.doesNotMatch(words, new RegExp(`\\b${word}\\b`), word);
    }, { context: { locale: "de-DE" } }],
    ["edit: bad files are refused with kind and place", async ({ page, url, write }) => {
        await go(page, url, "#/edit", ".handle");
        const before = JSON.stringify((await page.locator(".handle").count()));
        await file(page, write("bad.json", '{"type": "curve", "points": [[0,0],[1,'));
        assert.match(await toast(page), /unreadable|invalid/);
        await file(page, write("knots.json", '{"type": "curve", "degree": 2, "knots": [0,0,0,2,1,1,1], "points": [[0,0],[1,1],[2,0],[3,3]]}'));
        await settle(page);
        assert.match(await page.locator(".toast.refused").last().innerText(), /knots/);
        await file(page, write("part.iges", "ISO-10303-21;"));
        await settle(page);
        assert.match(await page.locator(".toast.refused").last().innerText(), /freiform view part\.iges/);
        await file(page, write("part.3dm", "3D Geometry File Format        8"));
        await settle(page);
        assert.match(await page.locator(".toast.refused").last().innerText(), /freiform view part\.3dm/);
        assert.equal(JSON.stringify(await page.locator(".handle").count()), before);
    }],
    ["edit and explore: by finger", async ({ page, url, context, picture }) => {
        await go(page, url, "#/explore/R15", ".handle");
        await picture("phone");
        const touch = await context.newCDPSession(page);
        const box = await page.locator(".handle").nth(1).boundingBox();
        const at = (x, y) => [{ x: box.x + box.width / 2 + x, y: box.y + box.height / 2 + y }];
        const before = await seen(page);
        await touch.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: at(0, 0) });
        for (let i = 1; i <= 5; ++i) await touch.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: at(6 * i, 5 * i) });
        await touch.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
        await settle(page);
        assert.notEqual(await seen(page), before);
    }, { context: { viewport: { width: 400, height: 800 }, hasTouch: true, isMobile: true } }],
    ["edit: by finger the gizmo moves one point and turns several", async ({ page, url, context, write, picture }) => {
        const net = [0, 1, 2].map((i) => [0, 1, 2].map((j) => [i, j, i === 1 && j === 1 ? 1.5 : 0]));
        await go(page, url, "#/edit", ".handle");
        await file(page, write("net.json", JSON.stringify({ freiform: 1, objects: [{ type: "surface", name: "net", points: net }] })));
        await page.waitForSelector(".view.space canvas");
        await page.getByLabel("Snap").uncheck();
        await page.locator(".view.space").scrollIntoViewIfNeeded();
        await settle(page);
        const touch = await context.newCDPSession(page);
        const middle = async (locator) => { const box = await locator.locator(":nth-child(2)").first().boundingBox(); return [box.x + box.width / 2, box.y + box.height / 2]; };
        const finger = async (locator, dx, dy) => {
            const [x, y] = await middle(locator), at = (k) => [{ x: x + k * dx, y: y + k * dy }];
            await touch.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: at(0) });
            for (let i = 1; i <= 4 && (dx !== 0 || dy !== 0); ++i) await touch.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: at(i / 4) });
            await touch.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
            await settle(page);
        };
        const point = (i) => page.locator(`.handles:not(.parts) .handle[aria-label$='point ${i}']`), parts = page.locator(".parts .handle");
        const part = (name) => page.locator(`.parts .handle[aria-label="${name}"]`);
        const now = async () => (await points(page)).objects[0].points.flat();

        await finger(point(4), 0, 0);
        assert.equal(await parts.count(), 3, "one point is moved");
        const first = await now(), [cx, cy] = await (async () => middle(point(4)))(), [zx, zy] = await middle(part("move, axis z"));
        const far = Math.hypot(zx - cx, zy - cy);
        await finger(part("move, axis z"), (50 * (zx - cx)) / far, (50 * (zy - cy)) / far);
        const lifted = await now();
        assert.ok(lifted[4][2] > first[4][2] + 0.05, `from ${first[4]} to ${lifted[4]}`);
        lifted.forEach((p, i) => { if (i !== 4) assert.deepEqual(p, first[i]); else assert.deepEqual(p.slice(0, 2), first[i].slice(0, 2)); });

        await page.getByRole("button", { name: "Several" }).tap();
        await finger(point(0), 0, 0);
        await finger(point(8), 0, 0);
        assert.equal(await parts.count(), 11, "three are turned and scaled, too");
        await picture("gizmo-touch");
        await finger(part("turn, axis z"), 30, -10);
        const turned = await now(), apart = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));
        assert.ok(apart(turned[0], lifted[0]) > 0.01, "turned");
        for (const [a, b] of [[0, 4], [4, 8], [0, 8]]) assert.ok(Math.abs(apart(turned[a], turned[b]) - apart(lifted[a], lifted[b])) < 1e-9);
        for (const i of [1, 2, 3, 5, 6, 7]) assert.deepEqual(turned[i], lifted[i], "not chosen");
        await finger(point(8), 0, 0);
        await finger(point(0), 0, 0);
        assert.equal(await parts.count(), 3, "a second touch lets go");
        assert.equal(await refused(page), "");
    }, { context: { viewport: { width: 820, height: 1100 }, hasTouch: true, isMobile: true } }],
    ["inspect: the teapot within its tolerance, looks, colours, section, nearest", async ({ page, url, picture }) => {
        await go(page, url, "#/inspect", ".view.space");
        const count = () => page.evaluate(() => Number(document.querySelector(".view.space").dataset.triangles ?? 0));
        await until(page, () => Number(document.querySelector(".view.space")?.dataset.triangles) > 100);
        await settle(page);
        await picture("teapot");
        const coarse = await count();
        const bound = await page.locator(".tools tr", { hasText: "error bound" }).locator("td").innerText();
        assert.ok(Number(bound) > 0);
        await page.getByLabel("Tolerance", { exact: true }).focus();
        for (let i = 0; i < 2; ++i) await page.keyboard.press("ArrowRight");
        await until(page, (was) => Number(document.querySelector(".view.space").dataset.triangles) > was, coarse);
        const shot = () => page.evaluate(() => document.querySelector("canvas").toDataURL());
        let before = await shot();
        for (const look of ["zebra", "isophotes", "normals", "flat", "shaded"]) {
            await page.locator('select[aria-label="Look"]').selectOption(look);
            await settle(page);
            const after = await shot();
            assert.notEqual(after, before, look);
            await picture(`teapot-${look}`);
            before = after;
        }
        for (const colours of ["faces", "gauss", "mean", "bound", "deviation"]) {
            await page.locator('select[aria-label="Colours"]').selectOption(colours);
            await settle(page);
            assert.equal(await refused(page), "", colours);
            if (colours !== "faces") await page.waitForSelector(".legend");
            await picture(`teapot-${colours}`);
        }
        await page.locator('select[aria-label="Colours"]').selectOption("plain");
        for (const name of ["Triangles", "Control net", "Knots", "Normals", "Cut by a plane"]) { before = await shot(); await page.getByLabel(name, { exact: true }).check(); await until(page, (was) => document.querySelector("canvas").toDataURL() !== was, before); await settle(page); assert.notEqual(await shot(), before, name); }
        await page.getByLabel(/Joints/).check();
        before = await shot();
        await until(page, (was) => document.querySelector("canvas").toDataURL() !== was, before);
        assert.equal(await refused(page), "");
        await picture("teapot-all");
        const box = await page.locator("canvas").boundingBox();
        await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
        await until(page, () => /u, v/.test(document.querySelector(".status").textContent));
        await page.locator("canvas").focus();
        before = await shot();
        await page.keyboard.press("ArrowLeft");
        await settle(page);
        assert.notEqual(await shot(), before, "arrow keys turn");
        await axe(page);
    }],
    ["inspect: a STEP file dropped anywhere is read in the browser; its refused faces say why", async ({ page, url, picture }) => {
        const triangles = () => page.evaluate(() => Number(document.querySelector(".view.space")?.dataset.triangles ?? 0));
        const entries = () => page.locator(".tools .list li:not(.bad)").count();
        await go(page, url, "#/explore/R5", ".page .side h1");
        await drop(page, "article", "bracket.step", bracket());
        await page.waitForSelector("text=bracket.step", { timeout: 60000 });
        await until(page, () => document.querySelectorAll(".tools .list li").length === 24);
        assert.match(page.url(), /#\/inspect$/);
        assert.equal(await refused(page), "");
        assert.equal(await page.locator(".list li.bad").count(), 0);
        assert.match(await page.locator(".tools tr", { hasText: "open edges" }).innerText(), /\b0$/);
        await settle(page);
        await picture("bracket");
        const coarse = await triangles();
        await page.getByLabel("Tolerance", { exact: true }).focus();
        for (let i = 0; i < 3; ++i) await page.keyboard.press("ArrowRight");
        await until(page, (was) => Number(document.querySelector(".view.space").dataset.triangles) > was, coarse);
        await drop(page, ".stage", "odd.stp", odd());
        await page.waitForSelector(".list li.bad", { timeout: 60000 });
        assert.match(await page.locator(".list li.bad").first().innerText(), /#\d+ ADVANCED_FACE: .*WRINKLED_SURFACE/);
        await until(page, () => document.querySelectorAll(".tools .list li:not(.bad)").length === 23);
        await picture("bracket-refused");
        assert.equal(await refused(page), "");
        const kept = await entries();
        await drop(page, ".stage", "half.step", bracket().slice(0, 60000));
        assert.match(await toast(page), /unreadable/);
        assert.equal(await entries(), kept, "a file that cannot be read leaves what is shown");
    }],
    ["inspect: parts of an assembly may be in files that come with it, also as a folder; those that are missing are named", async ({ page, url, picture }) => {
        const assembly = readFileSync(fileURLToPath(new URL("../../../tests/fuzz/seeds/step/documents.stp", import.meta.url)), "utf8");
        const listed = (bad, good) => until(page, ([bad, good]) => document.querySelectorAll(".list li.bad").length === bad && document.querySelectorAll(".tools .list li:not(.bad)").length === good, [bad, good]);
        await go(page, url, "#/inspect", ".view.space");
        await drop(page, ".stage", "assembly.stp", assembly);
        await listed(2, 1);
        assert.match(await page.locator(".list li.bad").nth(0).innerText(), /'a\.stp': cannot be read/);
        assert.match(await page.locator(".list li.bad").nth(1).innerText(), /'sub\/b\.stp': cannot be read/);
        await picture("assembly-alone");
        // Whatever comes first, and whatever capital letters the names have.
        await drop(page, ".stage", "assembly.stp", assembly, { "B.STP": bracket(), "a.stp": bracket() });
        await listed(0, 49);
        await page.waitForSelector("text=assembly.stp");
        assert.equal(await refused(page), "");
        await picture("assembly");
        await drop(page, ".stage", "x.stp", bracket(), { "y.stp": bracket() });
        assert.match(await toast(page), /y\.stp, x\.stp[^]*do not belong together/);
        await listed(0, 49);
        const folder = mkdtempSync(join(tmpdir(), "freiform-studio-"));
        try {
            mkdirSync(join(folder, "all", "sub"), { recursive: true });
            writeFileSync(join(folder, "all", "whole.stp"), assembly);
            writeFileSync(join(folder, "all", "notes.txt"), "nothing");
            writeFileSync(join(folder, "all", "sub", "b.stp"), bracket());
            const box = await page.locator("canvas").boundingBox();
            await dropFromDisk(page, box.x + box.width / 2, box.y + box.height / 2, [join(folder, "all")]);
            await listed(1, 25);
            assert.match(await page.locator(".list li.bad").innerText(), /'a\.stp': cannot be read/);
            await page.waitForSelector("text=whole.stp");
            const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.locator("[data-open]").click()]);
            await chooser.setFiles([join(folder, "all", "sub", "b.stp"), join(folder, "all", "whole.stp")]);
            await listed(1, 25);
        } finally {
            rmSync(folder, { recursive: true });
        }
    }],
    ["inspect: of many triangles few are drawn while the eye moves, all when it rests", async ({ page, url, picture }) => {
        await go(page, url, "#/inspect", ".view.space");
        await until(page, () => Number(document.querySelector(".view.space")?.dataset.triangles) > 100);
        const level = () => page.evaluate(() => document.querySelector(".view.space").dataset.level ?? "only");
        await page.locator("canvas").focus();
        await page.keyboard.press("ArrowLeft");
        assert.equal(await level(), "only", "the teapot within a thousandth is fluid as it is");
        await page.getByLabel("Tolerance", { exact: true }).focus();
        for (let i = 0; i < 17; ++i) await page.keyboard.press("ArrowRight");
        await until(page, () => Number(document.querySelector(".view.space").dataset.triangles) > 150000);
        const many = await page.evaluate(() => document.querySelector(".view.space").dataset.triangles);
        await page.locator("canvas").focus();
        await until(page, () => {
            document.querySelector("canvas").dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
            return document.querySelector(".view.space").dataset.level === "coarse";
        });
        await settle(page);
        await picture("level-coarse");
        await until(page, () => document.querySelector(".view.space").dataset.level === "fine");
        await settle(page);
        await picture("level-fine");
        assert.equal(await page.evaluate(() => document.querySelector(".view.space").dataset.triangles), many, "the count is of what is looked at");
    }],
    ["inspect: a model without faces is drawn as its edges", async ({ page, url, picture }) => {
        await go(page, url, "#/inspect", ".view.space");
        await drop(page, ".stage", "ring.step", ring("2."));
        await page.waitForSelector("text=ring.step");
        await until(page, () => document.querySelector("progress").hidden && document.querySelector(".view.space").dataset.triangles === "0");
        await settle(page);
        await picture("wireframe");
        assert.ok(drawn(await ink(page)) > 500, "a circle is seen");
    }],
    ["edit: a model without faces is drawn as its edges", async ({ page, url, picture }) => {
        await go(page, url, "#/inspect", ".view.space");
        await drop(page, ".stage", "ring.step", ring("2."));
        await page.waitForSelector("text=ring.step");
        await until(page, () => document.querySelector("progress").hidden && document.querySelector(".view.space").dataset.triangles === "0");
        await page.locator(".bar").getByRole("button", { name: "Edit" }).click();
        await page.getByLabel("Export as").waitFor();
        await page.getByRole("button", { name: "Fit" }).click();
        await settle(page);
        await picture("edit-wireframe");
        assert.ok(drawn(await ink(page)) > 500, "a circle is seen");
        assert.equal(await refused(page), "");
    }],
    ["edit: everything is in the picture, however long it is and wherever it is seen from", async ({ page, url, write, picture }) => {
        await go(page, url, "#/edit", ".view");
        const points = [0, 1].flatMap((i) => [[-1, -1, 40 * i], [1, -1, 40 * i], [1, 1, 40 * i], [-1, 1, 40 * i]]);
        await file(page, write("tall.json", JSON.stringify({ freiform: 1, objects: [{ type: "curve", degree: 1, knots: [0, 0, 1, 2, 3, 4, 5, 6, 7, 7], points }] })));
        for (const key of ["0", "1", "3"]) {
            await page.locator(".view.space").focus();
            await page.keyboard.press(key);
            await page.getByRole("button", { name: "Fit" }).click();
            await settle(page);
            if (key === "0") await picture("edit-fit-tall");
            const out = await page.evaluate(() => {
                const view = document.querySelector(".view.space").getBoundingClientRect();
                return [...document.querySelectorAll(".view.space .handle")].map((e) => e.getBoundingClientRect()).filter((r) => { const x = r.x + r.width / 2, y = r.y + r.height / 2; return !(x >= view.x + 8 && x <= view.right - 8 && y >= view.y + 8 && y <= view.bottom - 8); }).length;
            });
            assert.equal(out, 0, `points outside of the picture seen with key ${key}`);
            assert.ok(await page.locator(".view.space .handle").count() >= 8);
        }
    }],
    ["refusals name their kind in the language of the page", async ({ page, url }) => {
        for (const [language, word] of [["de", "unlesbar"], ["en", "unreadable"]]) {
            await page.addInitScript((language) => { localStorage.setItem("freiform.language", language); }, language);
            await go(page, url, "#/inspect", ".view.space");
            await page.reload();
            await page.waitForSelector(".view.space");
            await drop(page, ".stage", "broken.step", "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=");
            assert.match(await toast(page), new RegExp(`^${word}`));
        }
    }],
    ["inspect: after Cancel nothing of another file or tolerance stands under the name", async ({ page, url, picture }) => {
        // A worker that never begins takes as long as one has to press Cancel.
        await page.addInitScript(() => {
            const post = Worker.prototype.postMessage;
            Worker.prototype.postMessage = function (order, ...more) { if (order.task?.kind !== window.stalled) post.call(this, order, ...more); };
        });
        const facts = () => page.locator(".tools .readout").innerText(), names = (n) => until(page, (n) => document.querySelectorAll(".tools .list li").length === n, n);
        const cancel = async () => { await page.getByRole("button", { name: "Cancel" }).click(); await page.waitForSelector("text=Cancelled"); };
        const stall = (kind) => page.evaluate((kind) => { window.stalled = kind; }, kind);
        await go(page, url, "#/inspect", ".view.space");
        await names(32);
        await stall("mesh");
        await drop(page, ".stage", "bracket.step", bracket());
        await page.waitForSelector("text=bracket.step");
        assert.equal(await facts(), "");
        await names(0);
        await settle(page);
        assert.equal(drawn(await ink(page)), 0, "the picture is not of the teapot");
        await cancel();
        assert.match(await facts(), /Not meshed/);
        await picture("cancelled");
        await stall();
        const slider = page.getByLabel("Tolerance", { exact: true }), said = page.locator(".tools output").first();
        await slider.press("ArrowRight");
        await names(24);
        const [before, at] = [await facts(), await said.innerText()];
        await stall("mesh");
        await slider.press("ArrowRight");
        assert.notEqual(await said.innerText(), at);
        await cancel();
        assert.deepEqual([await facts(), await said.innerText()], [before, at], "what is said is about what is shown");
        await stall("read");
        await drop(page, ".stage", "other.step", bracket());
        await cancel();
        assert.equal(await page.locator(".bar strong").innerText(), "bracket.step");
        assert.equal(await refused(page), "");
        assert.ok(await page.locator("progress").isHidden());
    }],
    ["inspect: of a surface in the plane the nearest point is found, too", async ({ page, url, write, picture }) => {
        await go(page, url, "#/inspect", ".view.space");
        await file(page, write("plane.json", JSON.stringify({ freiform: 1, objects: [{ type: "surface", name: "flat", points: [[[0, 0], [0, 1]], [[1, 0], [1, 1]]] }] })));
        await page.waitForSelector("text=plane.json");
        await until(page, () => document.querySelector(".view.space").dataset.triangles === "2");
        const box = await page.locator("canvas").boundingBox();
        await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
        await until(page, () => /^flat · u, v = .*nearest point/.test(document.querySelector(".status").textContent));
        await picture("plane-surface");
    }],
    ["in space what is far from zero looks as what is near", async ({ page, url, write, picture }) => {
        const at = (x, y) => ({ freiform: 1, objects: [{ type: "surface", points: [0, 1, 2].map((i) => [0, 1, 2].map((j) => [x + i, y + j, i === 1 && j === 1 ? 2 : 0])) },
            { type: "curve", points: [[x, y, 2], [x + 1, y + 2, 2], [x + 2, y, 2]] }] });
        const look = async (part, text, then) => {
            await go(page, url, part, ".view.space, svg.plane");
            await file(page, write("far.json", JSON.stringify(text)));
            await page.waitForSelector(".view.space canvas");
            await then?.();
            await settle(page);
            await picture(`far-${part.slice(2)}-${text.objects[1].points[0][0]}`);
            return ink(page);
        };
        const inspected = async () => {
            await page.waitForSelector("text=far.json");
            await until(page, () => Number(document.querySelector(".view.space").dataset.triangles) > 100 && document.querySelector("progress").hidden);
            for (const name of ["Control net", "Normals", "Knots"]) await page.getByLabel(name, { exact: true }).check();
        };
        for (const [part, then] of [["#/edit", undefined], ["#/inspect", inspected]]) {
            const near = await look(part, at(0, 0), then);
            await page.goto("about:blank");
            const far = await look(part, at(524288, 5767168), then);
            await page.goto("about:blank");
            assert.ok(drawn(near) > 2000 && differing(near, far) < 0.01 * drawn(near), `${part}: ${differing(near, far)} pixels differ of ${drawn(near)}`);
        }
    }],
    ["inspect: sections and curvatures are found beside the page, which goes on answering; Cancel ends them", async ({ page, url, picture }) => {
        await page.addInitScript(() => {
            const post = Worker.prototype.postMessage;
            window.asked = [];
            Worker.prototype.postMessage = function (order, ...more) { window.asked.push(order.task?.kind); if (order.task?.kind !== window.stalled) post.call(this, order, ...more); };
        });
        const stall = (kind) => page.evaluate((kind) => { window.stalled = kind; }, kind), asked = (kind) => page.evaluate((kind) => window.asked.filter((x) => x === kind).length, kind);
        const idle = async () => { await until(page, () => document.querySelector("progress").hidden); await settle(page); };
        const shot = () => page.evaluate(() => document.querySelector("canvas").toDataURL());
        await go(page, url, "#/inspect", ".view.space");
        await until(page, () => Number(document.querySelector(".view.space")?.dataset.triangles) > 100);
        await idle();
        const plain = await shot(), colours = page.locator('select[aria-label="Colours"]'), cut = page.getByLabel("Cut by a plane"), place = page.getByLabel("Place of the plane");
        await colours.selectOption("gauss");
        await page.waitForSelector(".legend");
        await colours.selectOption("mean");
        await page.waitForSelector(".legend:has-text('mean')");
        await page.getByLabel("Triangles", { exact: true }).check();
        await page.getByLabel("Triangles", { exact: true }).uncheck();
        assert.equal(await asked("curvatures"), 1, "found once for the same triangles");
        await colours.selectOption("plain");
        await settle(page);
        assert.equal(await shot(), plain);
        await cut.check();
        await idle();
        const middle = await shot();
        assert.notEqual(middle, plain);
        await picture("section");
        const before = await asked("section");
        // A hand that draws the slider: more places than sections, and the last is shown.
        await place.evaluate((slider) => { for (let i = 0; i < 60; ++i) { slider.value = 0.5 + i / 200; slider.dispatchEvent(new Event("input")); } });
        await idle();
        const moved = await shot();
        assert.notEqual(moved, middle);
        assert.ok((await asked("section")) - before <= 3, `${(await asked("section")) - before} sections for one movement`);
        await place.evaluate((slider) => { slider.value = 0.7; slider.dispatchEvent(new Event("input")); });
        await idle();
        await place.evaluate((slider) => { slider.value = 0.795; slider.dispatchEvent(new Event("input")); });
        await idle();
        assert.equal(await shot(), moved, "the last place was shown");
        await stall("section");
        await place.press("ArrowRight");
        await page.getByRole("button", { name: "Cancel" }).click();
        assert.equal(await cut.isChecked(), false);
        await settle(page);
        assert.equal(await shot(), plain);
        await stall("curvatures");
        await page.getByLabel("Tolerance", { exact: true }).press("ArrowLeft");
        await idle();
        await colours.selectOption("gauss");
        await page.getByRole("button", { name: "Cancel" }).click();
        assert.equal(await colours.inputValue(), "plain");
        assert.ok(await page.locator("progress").isHidden());
        assert.equal(await refused(page), "");
    }],
    ["inspect: what changes lines leaves the surfaces on the graphics card", async ({ page, url }) => {
        await page.addInitScript(() => {
            const give = WebGL2RenderingContext.prototype.bufferData;
            window.given = 0;
            WebGL2RenderingContext.prototype.bufferData = function (...all) { window.given += all[1]?.byteLength ?? 0; give.apply(this, all); };
        });
        const given = async (act) => { await page.evaluate(() => { window.given = 0; }); await act(); await settle(page); return page.evaluate(() => window.given); };
        await go(page, url, "#/inspect", ".view.space");
        await until(page, () => Number(document.querySelector(".view.space")?.dataset.triangles) > 100);
        await settle(page);
        const comb = page.getByLabel(/Curvature comb/), look = page.locator('select[aria-label="Look"]');
        assert.equal(await given(() => comb.check()), 0, "there are no curves, so nothing is new");
        assert.ok((await given(() => look.selectOption("zebra"))) > 200000, "other surfaces are new");
        assert.ok((await given(() => page.getByRole("button", { name: "Light or dark" }).click())) > 200000, "so are those of another theme");
        assert.equal(await given(() => comb.uncheck()), 0);
    }],
    ["inspect: the chosen face stays marked and in sight with another tolerance; a long list says that it goes on", async ({ page, url, write, picture }) => {
        await go(page, url, "#/inspect", ".view.space");
        await until(page, () => document.querySelectorAll(".tools .list li").length === 32);
        const marked = page.locator('.tools .list [aria-pressed="true"]'), list = page.locator(".tools .list");
        await page.locator(".tools .list button").nth(20).click();
        const name = (await marked.innerText()).split(" · ")[0], text = await list.innerText();
        await page.getByLabel("Tolerance", { exact: true }).press("ArrowRight");
        await until(page, (was) => document.querySelector(".tools .list").innerText !== was && document.querySelector("progress").hidden, text);
        assert.equal(await marked.count(), 1);
        assert.equal((await marked.innerText()).split(" · ")[0], name);
        const [inner, outer] = [await marked.boundingBox(), await list.boundingBox()];
        assert.ok(inner.y >= outer.y && inner.y + inner.height <= outer.y + outer.height, "in sight");
        await list.scrollIntoViewIfNeeded();
        await picture("face-chosen");
        await marked.click();
        assert.equal(await marked.count(), 0);
        const flat = (i) => ({ type: "surface", name: `S${i}`, points: [[[i % 50, i / 50 | 0, 0], [i % 50, (i / 50 | 0) + 0.8, 0]], [[i % 50 + 0.8, i / 50 | 0, 0], [i % 50 + 0.8, (i / 50 | 0) + 0.8, 0]]] });
        await file(page, write("many.json", JSON.stringify({ freiform: 1, objects: Array.from({ length: 2100 }, (_, i) => flat(i)) })));
        await until(page, () => document.querySelector(".tools .list")?.innerText.startsWith("S0 "));
        assert.equal(await page.locator(".tools .list li").count(), 2001);
        await list.locator("li").last().scrollIntoViewIfNeeded();
        await picture("list-long");
        await page.getByRole("button", { name: "100 more" }).click();
        assert.equal(await page.locator(".tools .list li").count(), 2100);
        assert.match(await list.locator("li").last().innerText(), /^S2099 /);
    }],
    ["inspect: the keys that titles promise do it wherever the focus is", async ({ page, url }) => {
        await go(page, url, "#/inspect", ".view.space");
        await until(page, () => document.querySelectorAll(".tools .list li").length === 32);
        const shot = async () => { await settle(page); return page.evaluate(() => document.querySelector("canvas").toDataURL()); };
        const buttons = await page.locator(".bar button[title]").evaluateAll((all) => all.map((b) => [b.title, b.innerText]));
        assert.deepEqual(buttons.map(([title]) => title), ["Ctrl+O", "1", "3", "7", "0", "F", "5"]);
        for (const focus of ["canvas", 'input[type="range"]', "main"]) {
            for (const [key, name] of buttons.slice(1)) {
                const away = async () => { await page.getByRole("button", { name: "Right", exact: true }).click(); await page.getByRole("button", { name: "Fit", exact: true }).click(); await page.locator("canvas").press("ArrowUp"); await page.locator("canvas").press("+"); };
                await away();
                const before = await shot();
                await page.getByRole("button", { name, exact: true }).click();
                const byButton = await shot();
                if (key === "5") await page.getByRole("button", { name, exact: true }).click();
                await away();
                await page.locator(focus).first().focus();
                await page.keyboard.press(key);
                assert.ok((await shot()) === byButton, `${key} with the focus on ${focus} is ${name}`);
                assert.ok(byButton !== before, name);
                if (key === "5") await page.keyboard.press(key);
            }
        }
        const chooser = page.waitForEvent("filechooser", { timeout: 5000 });
        await page.keyboard.press("Control+o");
        await chooser;
        const colours = page.locator('select[aria-label="Colours"]'), still = await shot();
        await colours.focus();
        await page.keyboard.press("7");
        await page.keyboard.press("3");
        await settle(page);
        assert.ok((await shot()) === still, "what is typed in a list is the list's");
    }],
    ["inspect: legends say what their ends are", async ({ page, url, write, picture }) => {
        await go(page, url, "#/inspect", ".view.space");
        const colours = page.locator('select[aria-label="Colours"]'), words = () => page.locator(".legend").innerText();
        await until(page, () => Number(document.querySelector(".view.space")?.dataset.triangles) > 100);
        await colours.selectOption("gauss");
        await page.waitForSelector(".legend");
        assert.match(await words(), /^Gauss curvature\n≤ -[\d.]+\n0\n≥ [\d.]+\ngrey: no value$/, "the poles have none");
        await picture("legend");
        await file(page, write("flat.json", JSON.stringify({ freiform: 1, unit: "mm", objects: [{ type: "surface", points: [[[0, 0, 0], [0.1, 0.7, 0.3]], [[0.9, 0.2, 0.1], [1, 0.9, 0.4]]] }] })));
        await page.waitForSelector("text=flat.json");
        await until(page, () => document.querySelector(".view.space").dataset.triangles === "2" && document.querySelector(".legend"));
        assert.match(await words(), /^Gauss curvature \(1\/mm²\)\n0 everywhere$/, "a plane is not curved by rounding");
        await drop(page, ".stage", "ring.step", ring("2."));
        await page.waitForSelector("text=ring.step");
        await until(page, () => document.querySelector(".view.space").dataset.triangles === "0" && document.querySelector(".legend"));
        assert.match(await words(), /no value/);
        assert.equal(await refused(page), "");
    }],
    ["edit and inspect: fields keep within the panel, and the status line is read to its end", async ({ page, url, picture }) => {
        for (const other of ["Deutsch", "English"]) {
            await go(page, url, "#/edit", ".handle");
            await page.getByRole("button", { name: other }).click();
            await page.waitForSelector(".tools .list button");
            await page.locator(".tools .list button").first().click();
            await page.locator(".handle").first().press("Enter");
            await settle(page);
            await picture(`panel-edit-${other}`);
            assert.deepEqual(await beyond(page), []);
            await go(page, url, "#/inspect", ".view.space");
            await until(page, () => document.querySelectorAll(".tools .list li").length === 32);
            const canvas = page.locator("canvas"), box = await canvas.boundingBox();
            await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
            await until(page, () => /u, v/.test(document.querySelector(".status").textContent));
            await picture(`panel-inspect-${other}`);
            assert.deepEqual(await beyond(page), []);
            assert.ok(await page.locator(".status").evaluate((e) => e.scrollWidth <= e.clientWidth && e.scrollHeight <= e.clientHeight), "cut off");
            assert.deepEqual(await canvas.boundingBox(), box, "what is said leaves the picture where it is");
            await page.mouse.move(0, 0);
        }
    }],
    ["inspect: edges of models look alike whatever the size", async ({ page, url, picture }) => {
        await go(page, url, "#/inspect", ".view.space");
        await page.getByLabel("Knots", { exact: true }).check();
        const pictures = [];
        for (const radius of ["1.", "0.0009765625", "1048576."]) {
            await drop(page, ".stage", `ring${radius}.step`, ring(radius));
            await page.waitForSelector(`text=ring${radius}.step`);
            await until(page, () => document.querySelector("progress").hidden && document.querySelector(".view.space").dataset.triangles === "0");
            await settle(page);
            await picture(`ring-${radius}`);
            pictures.push(await ink(page));
        }
        assert.ok(drawn(pictures[0]) > 500, "a circle is seen");
        for (const other of pictures.slice(1)) assert.ok(differing(pictures[0], other) < 20, `${differing(pictures[0], other)} pixels differ of ${drawn(pictures[0])}`);
    }],
    ["freiform view: a STEP file, read by the program, with its faces and what the slider does", async ({ page, url, view, scratch, picture }) => {
        await page.goto(url);
        await until(page, () => document.querySelectorAll(".tools .list li").length === 24);
        assert.match(page.url(), /#\/inspect$/);
        assert.equal(await refused(page), "");
        assert.equal(await page.locator(".list li.bad").count(), 0);
        await settle(page);
        await picture("view-bracket");
        const bound = async () => Number(await page.locator(".tools tr", { hasText: "error bound" }).locator("td").innerText());
        const coarse = await bound();
        await page.getByLabel("Tolerance", { exact: true }).focus();
        for (let i = 0; i < 4; ++i) await page.keyboard.press("ArrowRight");
        for (let i = 0; i < 600 && !((await bound()) < coarse); ++i) await new Promise((done) => setTimeout(done, 100));
        assert.ok((await bound()) < coarse && (await bound()) > 0, "a finer tolerance has a smaller bound");
        const before = await page.evaluate(() => document.querySelector("canvas").toDataURL());
        await page.locator(".tools .list button").nth(3).click();
        await settle(page);
        assert.notEqual(await page.evaluate(() => document.querySelector("canvas").toDataURL()), before, "a face that is chosen is marked");
        await drop(page, ".stage", "bad.json", '{"type": "curve", "points": [[0,0],[1,');
        assert.match(await toast(page), /unreadable|invalid/);
        const bad = join(scratch, "bad.json");
        writeFileSync(bad, '{"type": "curve", "points": [[0,0],[1,');
        const ended = await view(bad).then(() => undefined, (error) => error);
        assert.equal(ended?.code, 3);
        assert.match(ended.complained, /bad\.json/);
    }, { view: () => example("bracket.step") }],
    ["freiform view: a 3DM file, read by the program, with its faces", async ({ page, url, picture }) => {
        await page.goto(url);
        await until(page, () => document.querySelectorAll(".tools .list li").length === 30);
        assert.equal(await refused(page), "");
        assert.equal(await page.locator(".list li.bad").count(), 0);
        await settle(page);
        await picture("view-3dm");
    }, { view: () => fileURLToPath(new URL("../../../tests/data/3dm/solids_8.3dm", import.meta.url)) }],
    ["freiform view: faces that were refused are marked, once each", async ({ page, url, picture }) => {
        await page.goto(url);
        await page.waitForSelector(".list li.bad", { timeout: 60000 });
        await until(page, () => document.querySelectorAll(".tools .list li:not(.bad)").length >= 1);
        await picture("view-refused");
        assert.match(await page.locator(".tools tr", { hasText: "refused" }).innerText(), /⚠ 1$/);
        const all = await page.locator(".list li.bad").allInnerTexts();
        assert.ok(all.length >= 1 && new Set(all).size === all.length, all.join("\n"));
    }, { view: (scratch) => { const path = join(scratch, "odd.step"); writeFileSync(path, odd()); return path; } }],
    ["inspect: what freiform view serves is opened, refused faces are marked", async ({ page, url }) => {
        await page.goto(url);
        await until(page, () => Number(document.querySelector(".view.space")?.dataset.triangles) > 0);
        assert.match(page.url(), /#\/inspect$/);
        await page.waitForSelector("text=part.step");
        await page.waitForSelector(".list li.bad");
        assert.match(await page.locator(".list li.bad").first().innerText(), /#17/);
    }, { extra: () => ({ "/view.json": JSON.stringify({ version: "0.1.0", file: "part.step", format: "step", unit: "mm", objects: [], models: 0, box: null }),
        "/document.json": JSON.stringify({ freiform: 1, unit: "mm", objects: [{ type: "surface", points: [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 1]]] }] }),
        "/faces.json": JSON.stringify({ faces: [], refused: [{ where: "#17", kind: "unsupported", message: "a surface that is not known" }], approximations: [] }) }) }],
    ["nothing leaves the machine, even if a script tried", async ({ page, url, trouble }) => {
        await go(page, url, "#/explore/R5", ".handle");
        const outcome = await page.evaluate(() => fetch("http://127.0.0.1:9/x").then(() => "sent", () => "blocked"));
        assert.equal(outcome, "blocked");
        assert.ok(trouble.some((line) => /Content Security Policy/.test(line)), trouble.join());
        trouble.length = 0;
    }],
    ["offline: the page opens again without a network", async ({ page, context, url }) => {
        await go(page, url, "#/explore/R5", ".handle");
        await page.evaluate(() => navigator.serviceWorker.ready.then(() => undefined));
        await page.reload();
        await page.waitForSelector(".handle");
        await settle(page);
        await context.setOffline(true);
        await page.reload();
        await page.waitForSelector(".handle", { timeout: 8000 });
        assert.equal(await refused(page), "");
    }],
];
