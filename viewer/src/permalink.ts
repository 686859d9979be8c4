// What the page shows, in the part of the address after #: a link, or a reload, comes back to the same view.

import type { LibrarySummary } from "./api/schema";
import { type Asked, BODY } from "./asked";
import { asCompared } from "./compared";
import { clamp } from "./numbers";
import { EXPOSURES, HOME, LIGHTS, type Orbit, TONES, TURNS, zoomed } from "./scene";
import { ASIDES, type Linked, PLOTS } from "./state";

/** What stands as it is at first is left out. */
const USUAL: Partial<Record<keyof Linked, string>> = {
  turn: "0",
  grain: "0",
  tone: "none",
  split: "0.5",
  axes: "gloss60,L,b",
  plot: "lobes",
  aside: "weights",
};

export function toHash(linked: Linked): string {
  const { azimuth, elevation, zoom } = linked.orbit;
  const fields: Record<keyof Linked, string> = {
    space: linked.space,
    blend: linked.blend,
    pace: linked.pace,
    stops: linked.stops.join(","),
    t: short(linked.t, 4),
    point: (linked.point ?? []).map((x) => String(Number(x.toPrecision(7)))).join(","),
    // The shortlist stays with the person who has it.
    compare: linked.compare.startsWith("kept:") ? "" : linked.compare,
    // A mesh stays with the person who has its file.
    shape: linked.shape === "mesh" ? "" : linked.shape,
    light: linked.light === "own" ? "" : linked.light,
    turn: short(linked.turn, 0),
    grain: short(linked.grain, 0),
    exposure: short(linked.exposure, 2),
    tone: linked.tone,
    split: short(linked.split, 3),
    map: linked.map,
    axes: linked.axes.join(","),
    tint: linked.tint,
    plot: linked.plot,
    aside: linked.aside,
    // What was found like one of the shortlist stays with the person who has it.
    asked: linked.asked?.like === null ? fromAsked(linked.asked) : "",
    orbit: [azimuth, elevation, zoom].map((x) => short(x, 3)).join(","),
  };
  return `#${Object.entries(fields)
    .filter(([key, value]) => value !== "" && value !== USUAL[key as keyof Linked])
    .map(([key, value]) => `${key}=${encodeURIComponent(value).replaceAll("%2C", ",")}`)
    .join("&")}`;
}

/** The fields that make sense for this library; the others are left out. */
export function fromHash(hash: string, library: LibrarySummary): Partial<Linked> {
  const fields = new URLSearchParams(hash.replace(/^#/, ""));
  const list = (key: keyof Linked) => (fields.get(key) ?? "").split(",").filter(Boolean);
  const oneOf = <T extends string>(key: keyof Linked, options: readonly T[]) =>
    options.find((option) => option === fields.get(key));
  const number = (key: keyof Linked, from: number, to: number) => {
    const value = Number.parseFloat(fields.get(key) ?? "");
    return Number.isFinite(value) ? clamp(value, from, to) : undefined;
  };
  const materials = library.materials.map(({ name }) => name);
  const spaces = library.spaces.map(({ name }) => name);
  const stops = list("stops").filter((name) => materials.includes(name));
  const distinct = stops.filter((name, i) => name !== stops[i - 1]);
  const point = list("point").map(Number.parseFloat);
  const sensible = {
    space: oneOf("space", spaces),
    blend: oneOf("blend", library.blends),
    pace: oneOf("pace", library.paces),
    stops: distinct.length >= 2 ? distinct : undefined,
    t: number("t", 0, 1),
    point: point.length && point.every(Number.isFinite) ? point : undefined,
    compare: oneOf("compare", [...spaces, ...materials.map(asCompared)]),
    shape: oneOf("shape", ["sphere", "teapot"]),
    light: oneOf("light", LIGHTS),
    turn: number("turn", ...TURNS),
    grain: number("grain", ...TURNS),
    tone: oneOf("tone", TONES),
    split: number("split", 0, 1),
    map: fields.get("map") || undefined,
    axes: toAxes(list("axes")),
    tint: fields.get("tint") || undefined,
    plot: oneOf("plot", PLOTS),
    aside: oneOf("aside", ASIDES),
    asked: toAsked(list("asked")),
    exposure: number("exposure", ...EXPOSURES),
    orbit: toOrbit(list("orbit").map(Number.parseFloat)),
  };
  return Object.fromEntries(Object.entries(sensible).filter(([, value]) => value !== undefined));
}

/** What a link asks for that makes no sense here, in one line; null where all does. */
export function unknownIn(hash: string, library: LibrarySummary): string | null {
  const fields = new URLSearchParams(hash.replace(/^#/, ""));
  const materials = new Set(library.materials.map(({ name }) => name));
  const understood: Partial<Linked> = fromHash(hash, library);
  const unknown = [...fields].flatMap(([key, value]) => {
    if (key === "stops") return value.split(",").filter((name) => name && !materials.has(name));
    return key in understood ? [] : [`${key} ${value}`];
  });
  if (unknown.length === 0) return null;
  return `The link asks for ${unknown.join(", ")}, which the explorer of ${library.name} does not have: it is shown without.`;
}

/** `gloss60:12.5,body:7a2a3a,highlight:free`. */
function fromAsked({ set, loose }: Asked): string {
  const written = (value: number | string) =>
    typeof value === "number" ? Number(value.toPrecision(5)) : value.slice(1);
  const wishes = Object.entries(set).map(([name, value]) => `${name}:${written(value)}`);
  return [...wishes, ...(loose ? [LOOSE] : [])].join(",");
}

const LOOSE = "highlight:free";

function toAsked(parts: readonly string[]): Asked | undefined {
  const pairs = parts
    .filter((part) => part !== LOOSE)
    .map((part) => part.split(":"))
    .map(
      ([name = "", value = ""]) =>
        [name, name === BODY ? toColour(value) : Number.parseFloat(value)] as const,
    );
  if (pairs.length === 0 || pairs.some(([, value]) => Number.isNaN(value))) return undefined;
  return { like: null, set: Object.fromEntries(pairs), loose: parts.includes(LOOSE) };
}

function toColour(digits: string): string | number {
  return /^[0-9a-f]{6}$/i.test(digits) ? `#${digits}` : Number.NaN;
}

function toAxes(names: readonly string[]): Linked["axes"] | undefined {
  const [x, y, z] = names;
  return x && y && z ? [x, y, z] : undefined;
}

function toOrbit(numbers: readonly number[]): Orbit | undefined {
  const [azimuth, elevation, zoom] = numbers;
  if (numbers.length !== 3 || !numbers.every(Number.isFinite)) return undefined;
  return zoomed({ azimuth: azimuth!, elevation: elevation!, zoom: HOME.zoom }, zoom!);
}

function short(x: number, digits: number): string {
  return String(Number(x.toFixed(digits)));
}
