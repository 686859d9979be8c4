// Tables on the graphics card: fetched when wanted, most wanted first; those wanted no more make room, the oldest first.

import * as THREE from "three";

import type { Client } from "../api/client";
import { type DrawableGrid, toDrawable } from "../brdf/grid";
import { lobe } from "../brdf/lobe";
import type { Table } from "../brdf/table";
import { sum } from "../numbers";
import { pauseAfter } from "../paced";
import { chances } from "./chances";
import { stack } from "./stack";

export interface TableOnCard {
  readonly table: Table;
  readonly texture: THREE.Data3DTexture;
  readonly scale: THREE.Vector3;
  /** Blocks of phi_h in the texture, and how many of them are above each other. */
  readonly turns: THREE.Vector2;
  /** How often to try half vectors of each theta_h, and of each phi_h at it. */
  readonly lobe: THREE.DataTexture;
  readonly lobeTurns: THREE.DataTexture;
}

/** Of the table of a mix: no material is called so. Without what tells it from others, of one that has not come. */
export function mixedName(which = "", small = false): string {
  return `${MIXED}${which}${small ? SMALL : ""}`;
}

/** Whether one is the full table of the mix that the other is the small one of. */
export function isFiner(name: string, than: string): boolean {
  return name.startsWith(MIXED) && than === name + SMALL;
}

const MIXED = "\0mixed ";
const SMALL = " small";
/** Of tables that are kept: 24 on the MERL grid, or as many smaller ones. */
const MAX_BYTES = 281e6;
const MAX_TABLES = 24;
/** How many are fetched that only the way ahead needs. */
const MAX_AHEAD = 4;
const AT_ONCE = 2;

export class Tables {
  /** Runs when a table has come, or could not. */
  onChange: (name: string, problem: string | null) => void = () => {};
  /** Runs when more of a table has come. */
  onProgress: () => void = () => {};
  private readonly loaded = new Map<string, TableOnCard>();
  /** The share of each that has come. */
  private readonly loading = new Map<string, number>();
  /** How often each failed, one after another; and those that are not asked for just now. */
  private readonly failures = new Map<string, number>();
  private readonly resting = new Set<string>();
  private wanted: readonly string[] = [];
  private readonly most: number;

  constructor(
    private readonly client: Client,
    readonly grid: DrawableGrid,
  ) {
    const bytes = 8 * grid.reduce((product, { size }) => product * size, 1);
    this.most = Math.min(MAX_TABLES, Math.floor(MAX_BYTES / bytes));
  }

  get(name: string): TableOnCard | undefined {
    return this.loaded.get(name);
  }

  /** Take in a table that was not fetched here. */
  put(table: Table): void {
    this.makeRoom();
    this.loaded.set(table.name, toCard(table));
  }

  /** The share of these tables that is here, in [0, 1]. */
  share(names: readonly string[]): number {
    const shares = names.map((name) => (this.loaded.has(name) ? 1 : (this.loading.get(name) ?? 0)));
    return sum(shares) / Math.max(names.length, 1);
  }

  /** All that are needed now, and some of those that come next, both in order of urgency; what is not among them may go. */
  want(needed: readonly string[], ahead: readonly string[] = []): void {
    const next = ahead.filter((name) => !needed.includes(name));
    const kept = next.filter((name, i) => i < MAX_AHEAD || this.loaded.has(name));
    this.wanted = [...needed, ...kept].slice(0, Math.max(this.most, needed.length));
    this.fetchNext();
  }

  private fetchNext(): void {
    for (const name of this.wanted) {
      if (this.loading.size >= AT_ONCE) return;
      if (this.loaded.has(name) || name.startsWith(MIXED) || this.loading.has(name) || this.resting.has(name))
        continue;
      this.loading.set(name, 0);
      void this.fetch(name);
    }
  }

  private async fetch(name: string): Promise<void> {
    let problem: string | null = null;
    try {
      const block = await this.client.table(name, (share) => {
        this.loading.set(name, share);
        this.onProgress();
      });
      this.makeRoom();
      this.failures.delete(name);
      this.loaded.set(name, toCard({ name, grid: this.grid, halfs: block.halfs, scale: block.scale }));
    } catch (error) {
      problem = error instanceof Error ? error.message : String(error);
      this.rest(name);
    }
    this.loading.delete(name);
    this.onChange(name, problem);
    this.fetchNext();
  }

  /** It is asked for again, later each time that it fails. */
  private rest(name: string): void {
    const failures = this.failures.get(name) ?? 0;
    this.failures.set(name, failures + 1);
    this.resting.add(name);
    const again = () => {
      this.resting.delete(name);
      this.fetchNext();
    };
    setTimeout(again, pauseAfter(failures));
  }

  private makeRoom(): void {
    for (const [name, { texture, lobe, lobeTurns }] of this.loaded) {
      // A mix that is not shown any more is never shown again: another has its own name.
      const mayGo = this.loaded.size >= this.most || name.startsWith(MIXED);
      if (this.wanted.includes(name) || !mayGo) continue;
      for (const each of [texture, lobe, lobeTurns]) each.dispose();
      this.loaded.delete(name);
    }
  }
}

function toCard(table: Table): TableOnCard {
  const { texels, size, turns } = stack(table);
  const texture = new THREE.Data3DTexture(texels, ...size);
  texture.format = THREE.RGBAFormat;
  texture.type = THREE.HalfFloatType;
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  texture.wrapS = THREE.RepeatWrapping;
  texture.wrapT = texture.wrapR = THREE.ClampToEdgeWrapping;
  texture.needsUpdate = true;
  const { mass, ofThetaH, density } = lobe(table);
  return {
    table,
    texture,
    scale: new THREE.Vector3(...table.scale),
    turns: new THREE.Vector2(...turns),
    lobe: chances(ofThetaH, density, ofThetaH.length),
    lobeTurns: chances(mass, mass, turns[0]),
  };
}

/** A white matte table of one sample, in the place of one that has not come. */
export function whiteTable(): TableOnCard {
  const angles = { theta_h: Math.PI / 2, theta_d: Math.PI / 2, phi_d: Math.PI };
  const grid = toDrawable(
    Object.entries(angles).map(([angle, stop]) => ({ angle, size: 1, stop, power: 1, periodic: false })),
  );
  return toCard({ name: "white", grid, halfs: new Uint16Array(4).fill(ONE), scale: [1, 1, 1] });
}

/** 1 as a half float. */
const ONE = 0x3c00;
