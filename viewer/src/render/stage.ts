// What stands on the stage and how it is looked at: the geometry buffer of each sample.
//
// World coordinates are those of `halfway.render`: x to the right of the camera, y away from it, z up.

import * as THREE from "three";
import { TeapotGeometry } from "three/addons/geometries/TeapotGeometry.js";

import type { Shape, View } from "../scene";
import { turnArm, widen } from "./camera";
import { disposeOccluder, type Occluder, toOccluder } from "./occluder";
import { meshMaterial, Pass, sphereShader } from "./shaders";

/** How a shape is seen before it is turned. */
interface Standpoint {
  readonly eye: THREE.Vector3;
  readonly target: THREE.Vector3;
  /** In degrees, of the width of what must be seen. */
  readonly fov: number;
  /** Width by height of what must be seen. */
  readonly aspect: number;
}

// The cameras of `halfway.render.scenes`; that of a mesh is the page's own.
const STANDPOINTS: Record<Shape, Standpoint> = {
  sphere: { eye: new THREE.Vector3(0, -12, 1), target: new THREE.Vector3(0, 0, 1), fov: 11, aspect: 1 },
  teapot: {
    eye: new THREE.Vector3(0.15, -13, 5.4),
    target: new THREE.Vector3(0.12, 0, 1.4),
    fov: 29,
    aspect: 1.3,
  },
  mesh: { eye: new THREE.Vector3(0, -12.5, 3.2), target: new THREE.Vector3(0, 0, 0), fov: 21, aspect: 1 },
};
const TEAPOT_HEIGHT = 3.15;
const TEAPOT_TURN = (-28 * Math.PI) / 180;

/** A mesh as it is drawn, and as it is in the light's way. */
interface Standing {
  readonly geometry: THREE.BufferGeometry;
  readonly scene: THREE.Scene;
  readonly occluder: Occluder;
}

export class Stage {
  readonly camera = new THREE.PerspectiveCamera();
  readonly target = new THREE.WebGLRenderTarget(1, 1, {
    count: 2,
    type: THREE.FloatType,
    minFilter: THREE.NearestFilter,
    magFilter: THREE.NearestFilter,
    depthBuffer: true,
  });
  private shape: Shape = "sphere";
  private readonly size = new THREE.Vector2(1, 1);
  private readonly toWorld = new THREE.Matrix4();
  private readonly standing = new Map<Shape, Standing>();
  readonly sphere = new Pass(sphereShader).set({
    uToWorld: this.toWorld,
    uEye: this.camera.position,
    uSize: this.size,
    uSphere: new THREE.Vector4(0, 0, 1, 1),
  });

  resize(width: number, height: number): void {
    this.size.set(width, height);
    this.target.setSize(width, height);
  }

  look({ shape, orbit, mesh }: View): void {
    this.shape = shape;
    if (shape === "teapot" && !this.standing.has(shape)) this.put(shape, teapot());
    if (shape === "mesh" && mesh !== null && mesh.geometry !== this.standing.get(shape)?.geometry)
      this.put(shape, mesh.geometry);
    const { eye, target, fov, aspect } = STANDPOINTS[shape];
    const { camera } = this;
    const arm = turnArm(eye.clone().sub(target), orbit.azimuth, orbit.elevation).divideScalar(orbit.zoom);
    camera.up.set(0, 0, 1);
    camera.position.copy(target).add(arm);
    camera.lookAt(target);
    camera.near = arm.length() / 10;
    camera.far = arm.length() * 3;
    widen(camera, this.size.x / this.size.y, fov, aspect);
    camera.updateMatrixWorld();
  }

  /** What casts shadows on itself; null where nothing does. */
  get occluder(): Occluder | null {
    return this.standing.get(this.shape)?.occluder ?? null;
  }

  private put(shape: Shape, geometry: THREE.BufferGeometry): void {
    const before = this.standing.get(shape);
    if (before) {
      before.geometry.dispose();
      disposeOccluder(before.occluder);
    }
    // First the occluder, which puts the triangles into its order.
    const occluder = toOccluder(geometry);
    this.standing.set(shape, { geometry, occluder, scene: new THREE.Scene().add(toObject(geometry)) });
  }

  /** Draw the buffer, seen through the point (x, y) of each pixel, in [0, 1). */
  draw(renderer: THREE.WebGLRenderer, x: number, y: number): void {
    const { width, height } = this.size;
    this.camera.setViewOffset(width, height, x - 0.5, y - 0.5, width, height);
    this.camera.updateMatrixWorld();
    if (this.shape === "sphere") {
      this.toWorld.multiplyMatrices(this.camera.matrixWorld, this.camera.projectionMatrixInverse);
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
function teapot(): THREE.BufferGeometry {
  const geometry = new TeapotGeometry(1, 24, true, true, true, false);
  geometry.rotateX(Math.PI / 2);
  geometry.computeBoundingBox();
  const { min, max } = geometry.boundingBox!;
  const scale = TEAPOT_HEIGHT / (max.z - min.z);
  geometry.translate(-(min.x + max.x) / 2, -(min.y + max.y) / 2, -min.z);
  return geometry.scale(scale, scale, scale).rotateZ(TEAPOT_TURN);
}

function toObject(geometry: THREE.BufferGeometry): THREE.Mesh {
  const mesh = new THREE.Mesh(geometry, meshMaterial());
  mesh.frustumCulled = false;
  return mesh;
}
