// Saving: the document as it is, pictures as they are seen, meshes within a tolerance.

import type { DocumentJson } from "freiform";
import { ff } from "../kernel/module";
import { download, h } from "../ui/dom";
import { keyed, say, t } from "../ui/language";
import { lacking, refuse } from "../ui/toast";
import { Plane } from "../views/plane";
import { Space } from "../views/space";
import type { View } from "../views/view";

/** An SVG drawing as PNG, twice as fine as the screen. */
async function rasterised(svg: string, width: number, height: number): Promise<Blob> {
    const image = new Image(width, height);
    image.src = `data:image/svg+xml,${encodeURIComponent(svg)}`;
    await image.decode();
    const canvas = h("canvas", { width: 2 * width, height: 2 * height });
    const pen = canvas.getContext("2d");
    if (!pen) throw new Error("canvas");
    pen.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--paper").trim();
    pen.fillRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(image, 0, 0, canvas.width, canvas.height);
    return new Promise((resolve, reject) => { canvas.toBlob((blob) => { if (blob) resolve(blob); else reject(new Error("canvas")); }, "image/png"); });
}

async function png(view: View): Promise<Blob> {
    if (view instanceof Space) return (await new Promise<Blob | null>((resolve) => { view.png(); view.canvas.toBlob(resolve, "image/png"); })) ?? new Blob();
    return view instanceof Plane ? rasterised(view.picturesque(), view.element.clientWidth, view.element.clientHeight) : new Blob();
}

const kFormats = ["svg", "png", "glb", "stl", "step"] as const;

export function exportButtons(document: () => DocumentJson, view: () => View, tolerance: () => number): HTMLElement[] {
    const save = (format: (typeof kFormats)[number]): void => {
        if (format === "png") { png(view()).then((blob) => { download("freiform.png", blob, "image/png"); }).catch(refuse); return; }
        const reply = format === "svg" ? ff().run("draw", document(), { to: "svg" }) : format === "step" ? ff().run("convert", document(), { to: "step" })
            : ff().run("tessellate", document(), { to: format, tolerance: tolerance() });
        download(`freiform.${format}`, reply.bytes, { svg: "image/svg+xml", glb: "model/gltf-binary", stl: "model/stl", step: "model/step" }[format]);
        lacking(`freiform.${format}`, (reply.report as { refused?: { where: string; message: string }[] } | null)?.refused ?? []);
    };
    const select = h("select", { "aria-label": say(t("Exportieren als", "Export as")), onchange: () => {
        const format = kFormats.find((f) => f === select.value);
        select.value = "";
        try { if (format) save(format); } catch (error) { refuse(error); }
    } }, h("option", { value: "" }, say(t("Exportieren …", "Export …"))), ...kFormats.map((f) => h("option", { value: f }, f.toUpperCase())));
    return [h("button", { title: keyed("Ctrl+S"), "data-save": true, onclick: () => {
        // The numbers as the module writes them: the shortest that read back to the same bits.
        try { download("freiform.json", JSON.stringify(document(), undefined, 1), "application/json"); } catch (error) { refuse(error); }
    } }, say(t("Speichern", "Save"))), select];
}
