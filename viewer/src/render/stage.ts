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
  /** Of the shorter side, in degrees. */
  readonly fov: number;
  /** At least this much from left to right. */
  readonly wide: number;
}

// The cameras of `halfway.render.scenes`.
const VIEWS: Record<Shape, View> = {
  sphere: { eye: new Vector3(0, -12, 1), target: new Vector3(0, 0, 1), fov: 11, wide: 11 },
  teapot: { eye: new Vector3(0.15, -13, 5.6), target: new Vector3(0.1, 0, 1.32), fov: 28, wide: 31 },
  mesh: { eye: new Vector3(0, -12.5, 3.2), target: new Vector3(0, 0, 0), fov: 21, wide: 21 },
};
const TEAPOT_HEIGHT = 3.15;
const TEAPOT_TURN = (-28 * Math.PI) / 180;
const UP = new Vector3(0, 0, 1);

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
  private readonly scenes: Readonly<Record<Exclude<Shape, "sphere">, Scene>> = {
    teapot: new Scene(),
    mesh: new Scene(),
  };
  private mesh: BufferGeometry | null = null;
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
    if (shape === "teapot" && this.scenes.teapot.children.length === 0)
      this.scenes.teapot.add(toObject(teapot()));
    if (shape === "mesh" && mesh !== null && mesh !== this.mesh) {
      this.mesh?.dispose();
      this.mesh = mesh;
      this.scenes.mesh.clear().add(toObject(mesh));
    }
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
    const [shorter, wide] = [view.fov, view.wide].map((degrees) => Math.tan((degrees * Math.PI) / 360));
    const { aspect } = this.camera;
    const half = Math.max(aspect < 1 ? shorter! / aspect : shorter!, wide! / aspect);
    this.camera.fov = (360 / Math.PI) * Math.atan(half);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
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
      renderer.render(this.scenes[this.shape], this.camera);
    }
  }
}

/** The pot of three's examples, standing on z = 0, spout to +x before it is turned. */
function teapot(): BufferGeometry {
  const geometry = new TeapotGeometry(1, 12);
  geometry.rotateX(Math.PI / 2);
  geometry.computeBoundingBox();
  const box = geometry.boundingBox!;
  const scale = TEAPOT_HEIGHT / (box.max.z - box.min.z);
  return geometry.translate(0, 0, -box.min.z).scale(scale, scale, scale).rotateZ(TEAPOT_TURN);
}

function toObject(geometry: BufferGeometry): Mesh {
  const mesh = new Mesh(geometry, meshMaterial());
  mesh.frustumCulled = false;
  return mesh;
}
