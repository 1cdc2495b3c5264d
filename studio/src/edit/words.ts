// What objects and steps are called.

import { t, type Text } from "../ui/language";

export const kNothing = t("Nichts ist gewählt.", "Nothing is chosen.");
export const kCurve = t("Kurve", "curve");
export const kChanges = { insert: t("Knoten einfügen", "insert knot"), split: t("Teilen", "split"), reduce: t("Knoten entfernen", "remove knots"), elevate: t("Grad erhöhen", "elevate"),
    reverse: t("Umkehren", "reverse"), bezier: t("Bézier-Stücke", "Bézier pieces") };
/** What is done, and what is made. */
export const kMakes = { revolve: [t("Drehen", "revolve"), t("Drehfläche", "revolve")], extrude: [t("Extrudieren", "extrude"), t("Ziehfläche", "extrude")], loft: [t("Loft", "loft"), t("Loft", "loft")],
    ruled: [t("Regelfläche", "ruled"), t("Regelfläche", "ruled")], coons: [t("Coons", "coons"), t("Coons", "coons")] } as const;
export const kKinds: Readonly<Record<string, Text>> = { curve: t("Kurve", "curve"), surface: t("Fläche", "surface"), volume: t("Körper", "volume"), triangle: t("Dreieck", "triangle"),
    trimmed: t("beschnittene Fläche", "trimmed"), model: t("Modell", "model") };
