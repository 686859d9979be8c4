// The materials as small lit spheres in three dimensions, with the triangulation, the present simplex and the route.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";

import type { Thumbnails } from "../thumbnails";
import { turnArm, widen } from "./camera";
import { toRenderer } from "./card";
import type { SpaceMap } from "./maps";
import { type Look, Spheres, type Tints } from "./spheres";

type Segment = readonly [THREE.Vector3, THREE.Vector3];

/** Of the camera, in degrees. */
const FOV = 32;
/** Of the route's line and of a crossing, in CSS pixels. */
const WIDTH = 2.5;
const DOT = 3.5;
/** From where the whole of it is seen. */
const HOME = new THREE.Vector3(1.2, -5.3, 0.7);
/** How much wider than a sphere one may point at it, in CSS pixels. */
const MARGIN = 2;

export class Cloud {
  readonly camera = new THREE.PerspectiveCamera(FOV, 1, 0.1, 50);
  readonly controls: OrbitControls;
  map: SpaceMap | null = null;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly spheres: Spheres;
  private readonly axes = lines(0.35);
  private readonly edges = lines(0.13);
  private readonly simplex = lines(0.8);
  private readonly route = new Line2(
    new LineGeometry(),
    new LineMaterial({ linewidth: WIDTH, depthTest: false, transparent: true, opacity: 0.9 }),
  );
  /** Where the route goes from one simplex into the next. */
  private readonly crossings = new THREE.Points(
    new THREE.BufferGeometry(),
    new THREE.PointsMaterial({ sizeAttenuation: false, depthTest: false, transparent: true }),
  );
  private readonly size = new THREE.Vector2(1, 1);
  private ratio = 1;

  constructor(canvas: HTMLCanvasElement, names: readonly string[], thumbnails: Thumbnails) {
    this.renderer = toRenderer({ canvas, alpha: true, antialias: true });
    this.camera.up.set(0, 0, 1);
    this.camera.position.copy(HOME);
    this.controls = new OrbitControls(this.camera, canvas);
    // Upwards and downwards a finger moves the page.
    canvas.style.touchAction = "pan-y";
    this.controls.enableDamping = false;
    // So every material can be come near to, also in the middle of thousands.
    this.controls.zoomToCursor = true;
    this.controls.minDistance = 0.25;
    this.controls.maxDistance = 14;
    this.spheres = new Spheres(names, thumbnails);
    canvas.addEventListener("webglcontextrestored", () => this.spheres.paint());
    const backToFront = [
      this.axes,
      this.edges,
      this.simplex,
      this.spheres.points,
      this.route,
      this.crossings,
    ];
    backToFront.forEach((object, i) => {
      object.frustumCulled = false;
      object.renderOrder = i;
    });
    this.scene.add(...backToFront);
    this.route.visible = this.crossings.visible = false;
  }

  /** Put the materials where `map` says, with the edges of a triangulation between them. */
  arrange(map: SpaceMap, edges: readonly (readonly [number, number])[]): void {
    this.map = map;
    this.spheres.arrange(map.points);
    setLines(
      this.edges,
      edges.map(([a, b]) => [map.points[a]!, map.points[b]!]),
    );
  }

  setAxes(segments: readonly Segment[]): void {
    setLines(this.axes, segments);
  }

  /** Lines from the present material to what it is made of, or between those. */
  setIngredients(segments: readonly Segment[]): void {
    setLines(this.simplex, segments);
  }

  setRoute(points: readonly THREE.Vector3[], crossings: readonly THREE.Vector3[]): void {
    this.crossings.visible = crossings.length > 0;
    this.crossings.geometry.dispose();
    this.crossings.geometry = new THREE.BufferGeometry().setFromPoints([...crossings]);
    this.route.visible = points.length > 1;
    if (points.length < 2) return;
    this.route.geometry.dispose();
    this.route.geometry = new LineGeometry();
    this.route.geometry.setPositions(points.flatMap((p) => p.toArray()));
  }

  setLooks(looks: readonly Look[]): void {
    this.spheres.setLooks(looks);
  }

  setTints(tints: Tints | null): void {
    this.spheres.setTints(tints);
  }

  setColours(text: string, accent: string, ground: string): void {
    for (const object of [this.axes, this.edges, this.simplex, this.crossings])
      object.material.color.set(text);
    this.route.material.color.set(accent);
    this.spheres.setColours(text, accent, ground);
  }

  resize(width: number, height: number, ratio: number): void {
    this.ratio = ratio;
    this.size.set(width, height);
    this.renderer.setPixelRatio(1);
    this.renderer.setSize(width, height, false);
    // A narrow panel looks from further away, so that the cloud stays in it.
    widen(this.camera, width / height, FOV);
    this.spheres.resize(width, height, ratio);
    this.route.material.linewidth = WIDTH * ratio;
    this.crossings.material.size = DOT * ratio;
    this.route.material.resolution.copy(this.size);
  }

  /** Back to where the whole of it is seen. */
  goHome(): void {
    this.camera.position.copy(HOME);
    this.controls.target.set(0, 0, 0);
    this.controls.update();
  }

  /** Whether nothing was moved but the camera around the whole of it. */
  get isHome(): boolean {
    const { target } = this.controls;
    return target.lengthSq() < 1e-6 && Math.abs(this.camera.position.length() - HOME.length()) < 1e-3;
  }

  draw(): void {
    this.spheres.approach(this.camera.position.distanceTo(this.controls.target));
    this.spheres.sort(this.map?.points ?? [], this.camera.position);
    this.renderer.render(this.scene, this.camera);
  }

  /** Turn the camera about what it looks at, by radians. */
  turn(azimuth: number, elevation: number): void {
    const { position } = this.camera;
    const { target } = this.controls;
    position.copy(turnArm(position.clone().sub(target), azimuth, elevation).add(target));
    this.controls.update();
  }

  dispose(): void {
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  /** Where a point is on the panel, in CSS pixels, and how far from the camera. */
  project(point: THREE.Vector3): { x: number; y: number; depth: number } {
    const p = point.clone().project(this.camera);
    const { x: width, y: height } = this.size;
    return {
      x: ((p.x + 1) / 2) * (width / this.ratio),
      y: ((1 - p.y) / 2) * (height / this.ratio),
      depth: p.z,
    };
  }

  /** The point under the pointer that is as far away as `near`. */
  unproject(x: number, y: number, near: THREE.Vector3): THREE.Vector3 {
    const { depth } = this.project(near);
    const clip = [(2 * x * this.ratio) / this.size.x - 1, 1 - (2 * y * this.ratio) / this.size.y] as const;
    return new THREE.Vector3(...clip, depth).unproject(this.camera);
  }

  /** The foremost material under the pointer, in CSS pixels; null beside all of them. */
  pick(x: number, y: number): number | null {
    let best: number | null = null;
    let foremost = 1;
    this.map?.points.forEach((point, i) => {
      const at = this.project(point);
      if (Math.hypot(at.x - x, at.y - y) > this.radius(point) + MARGIN || at.depth >= foremost) return;
      best = i;
      foremost = at.depth;
    });
    return best;
  }

  /** Of a material's sphere, in CSS pixels. */
  radius(point: THREE.Vector3): number {
    return this.spheres.radius(point, this.camera.position) / this.ratio;
  }
}

function lines(opacity: number): THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial> {
  return new THREE.LineSegments(
    new THREE.BufferGeometry(),
    new THREE.LineBasicMaterial({ transparent: true, opacity, depthWrite: false }),
  );
}

function setLines(object: THREE.LineSegments, segments: readonly Segment[]): void {
  object.geometry.dispose();
  const positions = segments.flatMap(([a, b]) => [...a.toArray(), ...b.toArray()]);
  object.geometry = new THREE.BufferGeometry().setAttribute(
    "position",
    new THREE.BufferAttribute(new Float32Array(positions), 3),
  );
}
