// The materials of the cloud: small lit spheres, cut from one picture of all thumbnails.

import * as THREE from "three";

import type { Thumbnails } from "../thumbnails";
import fragment from "./glsl/cloud.frag.glsl?raw";
import vertex from "./glsl/cloud.vert.glsl?raw";

/** How much a material is to be seen. */
export interface Look {
  readonly ring: "none" | "stop" | "hovered";
  readonly dim: boolean;
}

/** sRGB of each material in place of its picture; null for grey. */
export type Tints = readonly (readonly [number, number, number] | null)[];

/** Of a material that has no number. */
const UNKNOWN = [0.5, 0.5, 0.5] as const;
const RINGS = ["none", "stop", "hovered"] as const;
const PIXELS = 26;
/** Where a sphere is `PIXELS` wide. */
const DISTANCE = 5.5;
/** Materials whose spheres are that large; those of more are smaller, so that as much is seen between them. */
const FEW = 200;
/** Further than anything is away. */
const FRONT = 1e3;

export class Spheres {
  readonly points: THREE.Points<THREE.BufferGeometry, THREE.RawShaderMaterial>;
  private readonly positions: THREE.BufferAttribute;
  private readonly looks: THREE.BufferAttribute;
  private readonly tints: THREE.BufferAttribute;
  private readonly order: THREE.BufferAttribute;
  private readonly crowd: number;
  private pixels = PIXELS;

  constructor(
    private readonly names: readonly string[],
    private readonly thumbnails: Thumbnails,
  ) {
    const n = names.length;
    this.crowd = Math.min(1, Math.cbrt(FEW / n));
    this.positions = new THREE.BufferAttribute(new Float32Array(3 * n), 3);
    this.looks = new THREE.BufferAttribute(new Float32Array(2 * n), 2);
    this.tints = new THREE.BufferAttribute(new Float32Array(4 * n), 4);
    this.order = new THREE.BufferAttribute(new Uint32Array(n), 1);
    const tiles = new THREE.BufferAttribute(Float32Array.from(names.keys()), 1);
    const geometry = new THREE.BufferGeometry()
      .setAttribute("position", this.positions)
      .setAttribute("look", this.looks)
      .setAttribute("tint", this.tints)
      .setAttribute("tile", tiles)
      .setIndex(this.order);
    this.points = new THREE.Points(geometry, material());
    this.paint();
  }

  /** Give the card the pictures: at first, and when it has lost them. */
  paint(): void {
    const columns = Math.ceil(Math.sqrt(this.names.length));
    this.uniform("uColumns").value = columns;
    this.uniform("uAtlas").value = atlas(this.names, this.thumbnails, columns);
  }

  arrange(points: readonly THREE.Vector3[]): void {
    points.forEach(({ x, y, z }, i) => {
      this.positions.setXYZ(i, x, y, z);
    });
    this.positions.needsUpdate = true;
  }

  setLooks(looks: readonly Look[]): void {
    looks.forEach(({ ring, dim }, i) => {
      this.looks.setXY(i, RINGS.indexOf(ring), dim ? 1 : 0);
    });
    this.looks.needsUpdate = true;
  }

  /** Colours instead of pictures; null: pictures. */
  setTints(tints: Tints | null): void {
    for (let i = 0; i < this.tints.count; i++) {
      this.tints.setXYZW(i, ...(tints?.[i] ?? UNKNOWN), tints ? 1 : 0);
    }
    this.tints.needsUpdate = true;
  }

  setColours(text: string, accent: string, ground: string): void {
    const colours = { uStop: accent, uHovered: text, uGround: ground };
    for (const [uniform, css] of Object.entries(colours)) {
      // The shader writes to the screen as it is: no conversion to linear light.
      (this.uniform(uniform).value as THREE.Color).setStyle(css, "srgb-linear" as never);
    }
  }

  /** In a panel of this size, in device pixels of which `ratio` are one of CSS. */
  resize(width: number, height: number, ratio: number): void {
    const room = Math.min(1.5, Math.max(0.75, Math.min(width, height) / ratio / 480));
    this.pixels = PIXELS * ratio * room * this.crowd;
  }

  /** Seen from so near, spheres grow less than the room between them, so that one sees in among them. */
  approach(distance: number): void {
    this.uniform("uPixels").value = this.pixels * Math.min(1, Math.sqrt(distance / DISTANCE));
  }

  /** In device pixels, of a sphere at a point that is seen from `eye`. */
  radius(point: THREE.Vector3, eye: THREE.Vector3): number {
    return 0.5 * (this.uniform("uPixels").value as number) * (DISTANCE / point.distanceTo(eye));
  }

  /** From the back to the front; a stop, and what the pointer is on, is never hidden behind another. */
  sort(points: readonly THREE.Vector3[], eye: THREE.Vector3): void {
    const nearness = points.map((point, i) => (this.looks.getX(i) > 0 ? FRONT : 0) - point.distanceTo(eye));
    // In place: a new attribute would be a new buffer on the card with every drawing.
    const order = this.order.array as Uint32Array;
    order.set(points.map((_, i) => i));
    order.sort((a, b) => nearness[a]! - nearness[b]!);
    this.order.needsUpdate = true;
  }

  private uniform(name: string): { value: unknown } {
    return this.points.material.uniforms[name]!;
  }
}

function material(): THREE.RawShaderMaterial {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: vertex,
    fragmentShader: fragment,
    // Drawn from the back to the front, so that an edge lets through what is behind it.
    transparent: true,
    premultipliedAlpha: true,
    depthTest: false,
    depthWrite: false,
    uniforms: {
      uAtlas: { value: null },
      uColumns: { value: 1 },
      uPixels: { value: PIXELS },
      uDistance: { value: DISTANCE },
      uStop: { value: new THREE.Color() },
      uHovered: { value: new THREE.Color() },
      uGround: { value: new THREE.Color() },
    },
  });
}

function atlas(names: readonly string[], thumbnails: Thumbnails, columns: number): THREE.DataTexture {
  const side = thumbnails.size;
  const bytes = new Uint8Array(4 * (columns * side) ** 2);
  names.forEach((name, i) => {
    const { data } = thumbnails.of(name);
    const [left, top] = [(i % columns) * side, Math.floor(i / columns) * side];
    for (let y = 0; y < side; y++) {
      bytes.set(data.subarray(4 * y * side, 4 * (y + 1) * side), 4 * ((top + y) * columns * side + left));
    }
  });
  const texture = new THREE.DataTexture(
    bytes,
    columns * side,
    columns * side,
    THREE.RGBAFormat,
    THREE.UnsignedByteType,
  );
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  // The card has it: thousands of pictures take tens of megabytes.
  texture.onUpdate = () => {
    (texture.image as { data: Uint8Array | null }).data = null;
  };
  return texture;
}
