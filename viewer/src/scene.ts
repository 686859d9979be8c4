// What is looked at: an object, from somewhere, in a light.

import type { BufferGeometry } from "three";

import { clamp } from "./numbers";

/** `mesh` is a person's own. */
export type Shape = "sphere" | "teapot" | "mesh";

/** A person's own object, and its file's name. */
export interface OwnMesh {
  readonly name: string;
  readonly geometry: BufferGeometry;
}

/** Where the camera is, around what it looks at; angles in radians, 0 is the shape's own view. */
export interface Orbit {
  readonly azimuth: number;
  readonly elevation: number;
  readonly zoom: number;
}

export const HOME: Orbit = { azimuth: 0, elevation: 0, zoom: 1 };
const STEEPEST = 1.4;
const ZOOM = [0.3, 4] as const;

/** Turned by radians about the object, within what can be seen from. */
export function turned(orbit: Orbit, azimuth: number, elevation: number): Orbit {
  const up = clamp(orbit.elevation + elevation, -STEEPEST, STEEPEST);
  return { ...orbit, azimuth: orbit.azimuth + azimuth, elevation: up };
}

export function zoomed(orbit: Orbit, factor: number): Orbit {
  return { ...orbit, zoom: clamp(orbit.zoom * factor, ...ZOOM) };
}

/** Environments as pictures, which come with the page. */
// biome-ignore format: they are one list.
export const PICTURES = ["apartment", "city", "dawn", "forest", "lobby", "night", "park", "sunset", "warehouse"] as const;
export type Picture = (typeof PICTURES)[number];

/** How what is brighter than the screen is shown. */
export const TONES = ["none", "agx", "filmic"] as const;
export type Tone = (typeof TONES)[number];

/** Degrees that the light can be turned about the vertical, and a material against the tangent. */
export const TURNS = [-180, 180] as const;

/** A point turned by degrees about the vertical, as the picture of an environment is. */
export function turnedAbout(
  [x, y, z]: readonly [number, number, number],
  degrees: number,
): [number, number, number] {
  const [sine, cosine] = [Math.sin, Math.cos].map((f) => f((degrees * Math.PI) / 180));
  return [x * cosine! - y * sine!, x * sine! + y * cosine!, z];
}

/** The lights one can choose: the studio of `halfway.render`, the pictures, and three points. */
export const LIGHTS = ["studio", ...PICTURES, "points"] as const;
/** `own` is a person's own picture. */
export type Light = (typeof LIGHTS)[number] | "own";

/** Stops of exposure. */
export const EXPOSURES = [-4, 4] as const;

export interface View {
  readonly shape: Shape;
  readonly mesh: OwnMesh | null;
  readonly orbit: Orbit;
  readonly light: Light;
  /** Of the light about the vertical, in degrees. */
  readonly turn: number;
  /** Of the material against the tangent of the surface, counter-clockwise seen from outside, in degrees. */
  readonly grain: number;
}
