// The materials as small lit spheres in three dimensions, with the triangulation, the present simplex and the route.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  GLSL3,
  LinearFilter,
  LineBasicMaterial,
  LineSegments,
  MathUtils,
  PerspectiveCamera,
  Points,
  PointsMaterial,
  RawShaderMaterial,
  RGBAFormat,
  Scene,
  UnsignedByteType,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";

import type { Thumbnails } from "../thumbnails";
import type { Placement } from "./display";
import fragment from "./glsl/cloud.frag.glsl?raw";
import vertex from "./glsl/cloud.vert.glsl?raw";

/** How much a material is to be seen. */
export interface Look {
  readonly ring: "none" | "stop" | "hovered";
  readonly dim: boolean;
}

const PIXELS = 26;
/** Materials whose spheres are that large. */
const FEW = 200;
/** How far above or below the camera may stand, radians. */
const STEEPEST = 1.5;
/** Further than anything is away. */
const FRONT = 1e3;

export class Cloud {
  readonly camera = new PerspectiveCamera(32, 1, 0.1, 50);
  readonly controls: OrbitControls;
  placement: Placement | null = null;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly points: Points<BufferGeometry, RawShaderMaterial>;
  private readonly edges = new LineSegments(
    new BufferGeometry(),
    new LineBasicMaterial({ transparent: true, opacity: 0.13, depthWrite: false }),
  );
  private readonly simplex = new LineSegments(
    new BufferGeometry(),
    new LineBasicMaterial({ transparent: true, opacity: 0.8, depthWrite: false }),
  );
  private readonly route = new Line2(
    new LineGeometry(),
    new LineMaterial({
      linewidth: 2.5,
      worldUnits: false,
      depthTest: false,
      transparent: true,
      opacity: 0.9,
    }),
  );
  /** Where the route goes from one simplex into the next. */
  private readonly crossings = new Points(
    new BufferGeometry(),
    new PointsMaterial({ sizeAttenuation: false, depthTest: false, transparent: true }),
  );
  private readonly size = new Vector2(1, 1);
  private ratio = 1;
  /** Spheres of many materials are smaller, so that as much is seen between them. */
  private readonly crowd: number;

  constructor(
    canvas: HTMLCanvasElement,
    names: readonly string[],
    thumbnails: Thumbnails,
    onMove: () => void,
  ) {
    this.renderer = new WebGLRenderer({ canvas, alpha: true, antialias: true });
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(1.2, -5.3, 0.7);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.minDistance = 0.6;
    this.controls.maxDistance = 14;
    this.controls.addEventListener("change", onMove);
    this.crowd = Math.min(1, Math.cbrt(FEW / names.length));
    const columns = Math.ceil(Math.sqrt(names.length));
    this.points = new Points(
      new BufferGeometry(),
      new RawShaderMaterial({
        glslVersion: GLSL3,
        vertexShader: vertex,
        fragmentShader: fragment,
        // Drawn from the back to the front, so that an edge lets through what is behind it.
        transparent: true,
        premultipliedAlpha: true,
        depthTest: false,
        depthWrite: false,
        uniforms: {
          uAtlas: { value: atlas(names, thumbnails, columns) },
          uColumns: { value: columns },
          uPixels: { value: PIXELS },
          uDistance: { value: 5.5 },
          uStop: { value: new Color() },
          uHovered: { value: new Color() },
          uGround: { value: new Color() },
        },
      }),
    );
    this.points.geometry.setAttribute(
      "tile",
      new BufferAttribute(
        Float32Array.from(names, (_, i) => i),
        1,
      ),
    );
    this.points.geometry.setAttribute("look", new BufferAttribute(new Float32Array(2 * names.length), 2));
    for (const object of [this.points, this.edges, this.simplex, this.route, this.crossings])
      object.frustumCulled = false;
    this.edges.renderOrder = -2;
    this.simplex.renderOrder = -1;
    this.route.renderOrder = 1;
    this.crossings.renderOrder = 2;
    this.scene.add(this.edges, this.simplex, this.route, this.crossings, this.points);
    this.route.visible = this.crossings.visible = false;
  }

  /** Put the materials where `placement` says, with the edges of a triangulation between them. */
  arrange(placement: Placement, edges: readonly (readonly [number, number])[]): void {
    this.placement = placement;
    const positions = placement.points.flatMap((p) => p.toArray());
    this.points.geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
    this.setLines(
      this.edges,
      edges.map(([a, b]) => [placement.points[a]!, placement.points[b]!] as const),
    );
  }

  /** Lines from the present material to what it is made of, or between those. */
  setIngredients(pairs: readonly (readonly [Vector3, Vector3])[]): void {
    this.setLines(this.simplex, pairs);
  }

  private setLines(lines: LineSegments, pairs: readonly (readonly [Vector3, Vector3])[]): void {
    lines.geometry.dispose();
    lines.geometry = segments(pairs);
  }

  setRoute(points: readonly Vector3[], crossings: readonly Vector3[]): void {
    this.crossings.visible = crossings.length > 0;
    this.crossings.geometry.dispose();
    this.crossings.geometry = new BufferGeometry().setFromPoints([...crossings]);
    this.route.visible = points.length > 1;
    if (points.length < 2) return;
    this.route.geometry.dispose();
    this.route.geometry = new LineGeometry();
    this.route.geometry.setPositions(points.flatMap((p) => p.toArray()));
  }

  setLooks(looks: readonly Look[]): void {
    const attribute = this.points.geometry.getAttribute("look") as BufferAttribute;
    looks.forEach(({ ring, dim }, i) => {
      attribute.setXY(i, ring === "hovered" ? 2 : ring === "stop" ? 1 : 0, dim ? 1 : 0);
    });
    attribute.needsUpdate = true;
  }

  setColours(text: string, accent: string, ground: string): void {
    this.edges.material.color.set(text);
    this.simplex.material.color.set(text);
    this.route.material.color.set(accent);
    this.crossings.material.color.set(text);
    const { uStop, uHovered, uGround } = this.points.material.uniforms;
    for (const [uniform, css] of [
      [uStop, accent],
      [uHovered, text],
      [uGround, ground],
    ] as const) {
      // The shader writes to the screen as it is: no conversion to linear light.
      (uniform!.value as Color).setStyle(css, "srgb-linear" as never);
    }
  }

  resize(width: number, height: number, ratio: number): void {
    this.ratio = ratio;
    this.size.set(width, height);
    this.renderer.setPixelRatio(1);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // A narrow panel looks from further away, so that the cloud stays in it.
    this.camera.fov =
      width < height
        ? 2 * Math.atan((Math.tan((16 * Math.PI) / 180) * height) / width) * (180 / Math.PI)
        : 32;
    this.camera.updateProjectionMatrix();
    const room = Math.min(1.5, Math.max(0.75, Math.min(width, height) / ratio / 480));
    this.points.material.uniforms.uPixels!.value = PIXELS * ratio * room * this.crowd;
    this.route.material.linewidth = 2.5 * ratio;
    this.crossings.material.size = 3.5 * ratio;
    this.route.material.resolution.copy(this.size);
  }

  draw(): void {
    this.sort();
    this.renderer.render(this.scene, this.camera);
  }

  /** Turn the camera about what it looks at, by radians. */
  turn(azimuth: number, elevation: number): void {
    const { position } = this.camera;
    const { target } = this.controls;
    const { x, y, z } = position.clone().sub(target);
    const radius = Math.hypot(x, y, z);
    const up = MathUtils.clamp(Math.asin(z / radius) + elevation, -STEEPEST, STEEPEST);
    const around = Math.atan2(y, x) + azimuth;
    position.set(Math.cos(up) * Math.cos(around), Math.cos(up) * Math.sin(around), Math.sin(up));
    position.multiplyScalar(radius).add(target);
    this.controls.update();
  }

  dispose(): void {
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  /** From the back to the front; a stop, and what the pointer is on, is never hidden behind another. */
  private sort(): void {
    const places = this.placement?.points ?? [];
    const looks = this.points.geometry.getAttribute("look");
    const nearness = places.map(
      (place, i) => -place.distanceTo(this.camera.position) + (looks.getX(i) > 0 ? FRONT : 0),
    );
    const order = Uint32Array.from(places.keys()).sort((a, b) => nearness[a]! - nearness[b]!);
    this.points.geometry.setIndex(new BufferAttribute(order, 1));
  }

  /** Where a point is on the panel, in CSS pixels, and how far from the camera. */
  project(point: Vector3): { x: number; y: number; depth: number } {
    const p = point.clone().project(this.camera);
    const { x: width, y: height } = this.size;
    return {
      x: ((p.x + 1) / 2) * (width / this.ratio),
      y: ((1 - p.y) / 2) * (height / this.ratio),
      depth: p.z,
    };
  }

  /** The place under the pointer that is as far away as `near`. */
  unproject(x: number, y: number, near: Vector3): Vector3 {
    const { depth } = this.project(near);
    const clip = [(2 * x * this.ratio) / this.size.x - 1, 1 - (2 * y * this.ratio) / this.size.y] as const;
    return new Vector3(...clip, depth).unproject(this.camera);
  }

  /** The material at a place of the panel, in CSS pixels; null beside all of them. */
  pick(x: number, y: number): number | null {
    if (this.placement === null) return null;
    let best: { i: number; depth: number } | null = null;
    this.placement.points.forEach((point, i) => {
      const at = this.project(point);
      const radius = this.radius(point) + 2;
      if (Math.hypot(at.x - x, at.y - y) > radius || at.depth > 1) return;
      if (best === null || at.depth < best.depth) best = { i, depth: at.depth };
    });
    return (best as { i: number } | null)?.i ?? null;
  }

  /** Of a material's sphere, in CSS pixels. */
  radius(point: Vector3): number {
    const pixels = this.points.material.uniforms.uPixels!.value as number;
    return ((0.5 * pixels) / this.ratio) * (5.5 / point.distanceTo(this.camera.position));
  }
}

function segments(pairs: readonly (readonly [Vector3, Vector3])[]): BufferGeometry {
  const positions = pairs.flatMap(([a, b]) => [...a.toArray(), ...b.toArray()]);
  return new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
}

function atlas(names: readonly string[], thumbnails: Thumbnails, columns: number): DataTexture {
  const side = thumbnails.size;
  const bytes = new Uint8Array(4 * (columns * side) ** 2);
  names.forEach((name, i) => {
    const { data } = thumbnails.of(name);
    const [left, top] = [(i % columns) * side, Math.floor(i / columns) * side];
    for (let y = 0; y < side; y++) {
      bytes.set(data.subarray(4 * y * side, 4 * (y + 1) * side), 4 * ((top + y) * columns * side + left));
    }
  });
  const texture = new DataTexture(bytes, columns * side, columns * side, RGBAFormat, UnsignedByteType);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
