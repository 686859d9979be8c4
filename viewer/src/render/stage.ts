// What stands on the stage and how it is looked at: the geometry buffer of each sample.
//
// World coordinates are those of `halfway.render`: x to the right of the camera, y away from it, z up.

import {
  type BufferGeometry,
  FloatType,
  Matrix4,
  Mesh,
  NearestFilter,
  PerspectiveCamera,
  Scene,
  Vector2,
  Vector3,
  Vector4,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { TeapotGeometry } from "three/addons/geometries/TeapotGeometry.js";

import { disposeOccluder, type Occluder, toOccluder } from "./occluder";
import { meshMaterial, Pass, sphereShader } from "./shaders";

/** `mesh` is a person's own. */
export type Shape = "sphere" | "teapot" | "mesh";

/** Where the camera is, around what it looks at; angles in radians, 0 is the shape's own view. */
export interface Orbit {
  readonly azimuth: number;
  readonly elevation: number;
  readonly zoom: number;
}

export const HOME: Orbit = { azimuth: 0, elevation: 0, zoom: 1 };

interface View {
  readonly eye: Vector3;
  readonly target: Vector3;
  /** In degrees, of the width of what must be seen. */
  readonly fov: number;
  /** Width by height of what must be seen. */
  readonly aspect: number;
}

// The cameras of `halfway.render.scenes`; that of a mesh is the page's own.
const VIEWS: Record<Shape, View> = {
  sphere: { eye: new Vector3(0, -12, 1), target: new Vector3(0, 0, 1), fov: 11, aspect: 1 },
  teapot: { eye: new Vector3(0.15, -13, 5.4), target: new Vector3(0.12, 0, 1.4), fov: 29, aspect: 1.3 },
  mesh: { eye: new Vector3(0, -12.5, 3.2), target: new Vector3(0, 0, 0), fov: 21, aspect: 1 },
};
const TEAPOT_HEIGHT = 3.15;
const TEAPOT_TURN = (-28 * Math.PI) / 180;
const UP = new Vector3(0, 0, 1);

/** A mesh as it is drawn, and as it is in the light's way. */
interface Standing {
  readonly geometry: BufferGeometry;
  readonly scene: Scene;
  readonly occluder: Occluder;
}

export class Stage {
  readonly camera = new PerspectiveCamera();
  readonly target = new WebGLRenderTarget(1, 1, {
    count: 2,
    type: FloatType,
    minFilter: NearestFilter,
    magFilter: NearestFilter,
    depthBuffer: true,
  });
  private shape: Shape = "sphere";
  private readonly size = new Vector2(1, 1);
  private readonly standing = new Map<Shape, Standing>();
  readonly sphere = new Pass(sphereShader, {
    uToWorld: { value: new Matrix4() },
    uEye: { value: this.camera.position },
    uSize: { value: this.size },
    uSphere: { value: new Vector4(0, 0, 1, 1) },
  });

  resize(width: number, height: number): void {
    this.size.set(width, height);
    this.target.setSize(width, height);
  }

  look(shape: Shape, orbit: Orbit, mesh: BufferGeometry | null): void {
    this.shape = shape;
    if (shape === "teapot" && !this.standing.has(shape)) this.put(shape, teapot());
    if (shape === "mesh" && mesh !== null && mesh !== this.standing.get(shape)?.geometry)
      this.put(shape, mesh);
    const view = VIEWS[shape];
    const arm = view.eye.clone().sub(view.target);
    const distance = arm.length() / orbit.zoom;
    const elevation = Math.asin(arm.z / arm.length()) + orbit.elevation;
    const azimuth = Math.atan2(arm.y, arm.x) + orbit.azimuth;
    const limited = Math.min(Math.max(elevation, -1.5), 1.5);
    arm.set(Math.cos(limited) * Math.cos(azimuth), Math.cos(limited) * Math.sin(azimuth), Math.sin(limited));
    this.camera.up.copy(UP);
    this.camera.position.copy(view.target).addScaledVector(arm, distance);
    this.camera.lookAt(view.target);
    this.camera.near = distance / 10;
    this.camera.far = distance * 3;
    this.camera.aspect = this.size.x / this.size.y;
    const half = Math.tan((view.fov * Math.PI) / 360) / Math.min(view.aspect, this.camera.aspect);
    this.camera.fov = (360 / Math.PI) * Math.atan(half);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }

  /** What casts shadows on itself; null where nothing does. */
  get occluder(): Occluder | null {
    return this.standing.get(this.shape)?.occluder ?? null;
  }

  private put(shape: Shape, geometry: BufferGeometry): void {
    const before = this.standing.get(shape);
    if (before) {
      before.geometry.dispose();
      disposeOccluder(before.occluder);
    }
    // First the occluder, which puts the triangles into its order.
    const occluder = toOccluder(geometry);
    this.standing.set(shape, { geometry, occluder, scene: new Scene().add(toObject(geometry)) });
  }

  /** Draw the buffer, seen through the point (x, y) of each pixel, in [0, 1). */
  draw(renderer: WebGLRenderer, x: number, y: number): void {
    const { width, height } = this.size;
    this.camera.setViewOffset(width, height, x - 0.5, y - 0.5, width, height);
    this.camera.updateMatrixWorld();
    if (this.shape === "sphere") {
      const toWorld = this.sphere.uniforms.uToWorld!.value as Matrix4;
      toWorld.multiplyMatrices(this.camera.matrixWorld, this.camera.projectionMatrixInverse);
      this.sphere.draw(renderer, this.target);
    } else {
      renderer.setRenderTarget(this.target);
      renderer.setClearColor(0x000000, 0);
      renderer.clear();
      const standing = this.standing.get(this.shape);
      if (standing) renderer.render(standing.scene, this.camera);
    }
  }
}

/** three's pot with the lid as published; the middle of its foot is the origin, its spout points to +x before the turn. */
function teapot(): BufferGeometry {
  const geometry = new TeapotGeometry(1, 24, true, true, true, false);
  geometry.rotateX(Math.PI / 2);
  geometry.computeBoundingBox();
  const { min, max } = geometry.boundingBox!;
  const scale = TEAPOT_HEIGHT / (max.z - min.z);
  geometry.translate(-(min.x + max.x) / 2, -(min.y + max.y) / 2, -min.z);
  return geometry.scale(scale, scale, scale).rotateZ(TEAPOT_TURN);
}

function toObject(geometry: BufferGeometry): Mesh {
  const mesh = new Mesh(geometry, meshMaterial());
  mesh.frustumCulled = false;
  return mesh;
}
