// What the page shows, in the part of the address after #: a link, or a reload, comes back to the same place.

import type { LibrarySummary } from "./api/schema";
import { LIGHTS } from "./render/environments";
import type { Linked } from "./state";

export function toHash(linked: Linked): string {
  const { azimuth, elevation, zoom } = linked.orbit;
  const fields: Record<string, string> = {
    space: linked.space,
    pace: linked.pace,
    stops: linked.stops.join(","),
    t: short(linked.t, 4),
    point: (linked.point ?? []).map((x) => String(Number(x.toPrecision(7)))).join(","),
    compare: linked.compare,
    // A mesh stays with the person who has its file.
    shape: linked.shape === "mesh" ? "" : linked.shape,
    light: linked.light,
    exposure: short(linked.exposure, 2),
    orbit: [azimuth, elevation, zoom].map((x) => short(x, 3)).join(","),
  };
  return `#${Object.entries(fields)
    .filter(([, value]) => value !== "")
    .map(([key, value]) => `${key}=${encodeURIComponent(value).replaceAll("%2C", ",")}`)
    .join("&")}`;
}

/** The fields that make sense for this library; the others are left out. */
export function fromHash(hash: string, library: LibrarySummary): Partial<Linked> {
  const fields = new URLSearchParams(hash.replace(/^#/, ""));
  const oneOf = <T extends string>(key: string, options: readonly T[]) =>
    options.find((o) => o === fields.get(key));
  const number = (key: string, from: number, to: number) => {
    const value = Number.parseFloat(fields.get(key) ?? "");
    return Number.isFinite(value) ? Math.min(Math.max(value, from), to) : undefined;
  };
  const names = new Set(library.materials.map(({ name }) => name));
  const stops = (fields.get("stops") ?? "").split(",").filter((name) => names.has(name));
  const distinct = stops.filter((name, i) => name !== stops[i - 1]);
  const orbit = (fields.get("orbit") ?? "").split(",").map(Number.parseFloat);
  const point = (fields.get("point") ?? "").split(",").filter(Boolean).map(Number.parseFloat);
  const [azimuth, elevation, zoom] = orbit;
  return defined({
    space: oneOf(
      "space",
      library.spaces.map(({ name }) => name),
    ),
    pace: oneOf("pace", library.paces),
    stops: distinct.length >= 2 ? distinct : undefined,
    t: number("t", 0, 1),
    point: point.length && point.every(Number.isFinite) ? point : undefined,
    compare: oneOf("compare", [
      ...library.spaces.map(({ name }) => name),
      ...library.materials.map(({ name }) => `stop:${name}`),
    ]),
    shape: oneOf("shape", ["sphere", "teapot"] as const),
    light: oneOf("light", LIGHTS),
    exposure: number("exposure", -4, 4),
    orbit:
      orbit.length === 3 && orbit.every(Number.isFinite)
        ? { azimuth: azimuth!, elevation: elevation!, zoom: Math.min(Math.max(zoom!, 0.3), 4) }
        : undefined,
  });
}

type Optional<T> = { [K in keyof T]?: T[K] | undefined };

function defined(fields: Optional<Linked>): Partial<Linked> {
  return Object.fromEntries(
    Object.entries(fields).filter(([, value]) => value !== undefined),
  ) as Partial<Linked>;
}

function short(x: number, digits: number): string {
  return String(Number(x.toFixed(digits)));
}
