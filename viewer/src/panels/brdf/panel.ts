// The BRDF itself: polar lobes for a light direction, or a slice of the table.

import type { Direction } from "../brdf/halfdiff";
import { evaluate, type Rgb, sample, type Table } from "../brdf/table";
import { toByte } from "../colour";
import type { Context } from "../context";
import { el, onResize, segments, style } from "../dom";
import type { Ingredient } from "../recipe";

type View = "lobes" | "slice";

export function brdfPanel({ store, tables }: Context): HTMLElement {
  let view: View = "lobes";
  let degrees = 45;
  let phi = 90;
  const canvas = el("canvas", { role: "img", "aria-label": "The BRDF of the mixed material" });
  const choice = segments<View>(
    "BRDF view",
    [
      ["lobes", "Lobes"],
      ["slice", "Slice"],
    ],
    (next) => {
      view = next;
      update();
    },
  );
  const name = el("span");
  const input = el(
    "input",
    { type: "range", min: 0, step: 1, "aria-label": "Angle" },
    {
      oninput: () => {
        if (view === "lobes") degrees = Number(input.value);
        else phi = Number(input.value);
        update();
      },
    },
  );
  const output = el("output");
  let scheduled = false;
  const update = () => {
    choice.mark(view);
    name.replaceChildren(view === "lobes" ? "θ" : "φ", el("sub", {}, {}, view === "lobes" ? "i" : "d"));
    input.max = view === "lobes" ? "85" : "179";
    input.value = String(view === "lobes" ? degrees : phi);
    output.textContent = `${input.value}°`;
    if (scheduled) return;
    scheduled = true;
    requestAnimationFrame(() => {
      scheduled = false;
      draw();
    });
  };
  const draw = () => {
    const context = canvas.getContext("2d")!;
    const ratio = canvas.width / Math.max(canvas.clientWidth, 1);
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    const parts = ready(store.get().recipe, (material) => tables.get(material)?.table);
    if (parts === null || canvas.width === 0) return;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const size = { width: canvas.width / ratio, height: canvas.height / ratio };
    if (view === "lobes") drawLobes(context, size, parts, (degrees * Math.PI) / 180);
    else drawSlice(context, size, parts, phi);
  };
  onResize(canvas, (width, height) => {
    canvas.width = width;
    canvas.height = height;
    update();
  });
  store.watch(({ recipe }) => recipe, update);
  store.watch(({ arrived, scheme }) => [arrived, scheme], update);
  update();
  return el(
    "section.panel.brdf",
    { "aria-label": "BRDF" },
    {},
    el("div.titled", {}, {}, el("h2", {}, {}, "BRDF"), choice.element),
    canvas,
    el("label", {}, {}, name, input, output),
  );
}

type Part = readonly [Table, Rgb];
interface Size {
  readonly width: number;
  readonly height: number;
}

/** The tables of a recipe with their weights; null while one is missing. */
function ready(recipe: readonly Ingredient[], table: (name: string) => Table | undefined): Part[] | null {
  const parts: Part[] = [];
  for (const { name, weight } of recipe) {
    const found = table(name);
    if (found === undefined) return null;
    parts.push([found, weight]);
  }
  return parts.length ? parts : null;
}

function mixed(parts: readonly Part[], value: (table: Table) => Rgb | null): Rgb {
  let [r, g, b] = [0, 0, 0];
  for (const [table, weight] of parts) {
    const rgb = value(table);
    if (rgb === null) return [0, 0, 0];
    r += weight[0] * rgb[0];
    g += weight[1] * rgb[1];
    b += weight[2] * rgb[2];
  }
  return [r, g, b];
}

/** How far from the middle a value is drawn: its cube root, so that matte and highlight both show. */
const radius = (value: number) => Math.cbrt(Math.max(value, 0));

function drawLobes(
  context: CanvasRenderingContext2D,
  { width, height }: Size,
  parts: readonly Part[],
  thetaI: number,
): void {
  const wi: Direction = [Math.sin(thetaI), 0, Math.cos(thetaI)];
  const angles = Array.from({ length: 359 }, (_, i) => ((i - 179) / 2) * (Math.PI / 180));
  const lobes = angles.map((angle) =>
    mixed(parts, (table) => evaluate(table, wi, [-Math.sin(angle), 0, Math.cos(angle)])),
  );
  const largest = Math.max(...lobes.flat(), 1e-6);
  const reach = Math.min(width / 2 - 14, height - 30);
  const scale = reach / radius(largest);
  const [x0, y0] = [width / 2, height - 18];
  drawRings(context, x0, y0, reach, scale, largest);
  const colours = ["--red", "--green", "--blue"].map((name) => style(context.canvas, name));
  context.globalCompositeOperation =
    context.canvas.closest<HTMLElement>("[data-theme]")?.dataset.theme === "light" ? "multiply" : "screen";
  for (let c = 0; c < 3; c++) {
    context.beginPath();
    lobes.forEach((rgb, i) => {
      const r = scale * radius(rgb[c]!);
      context.lineTo(x0 + r * Math.sin(angles[i]!), y0 - r * Math.cos(angles[i]!));
    });
    context.closePath();
    context.fillStyle = `${colours[c]}33`;
    context.strokeStyle = colours[c]!;
    context.lineWidth = 1.5;
    context.fill();
    context.stroke();
  }
  context.globalCompositeOperation = "source-over";
  drawRay(context, x0, y0, reach, thetaI);
}

function drawRings(
  context: CanvasRenderingContext2D,
  x0: number,
  y0: number,
  reach: number,
  scale: number,
  largest: number,
): void {
  context.strokeStyle = style(context.canvas, "--line");
  context.fillStyle = style(context.canvas, "--quiet");
  context.lineWidth = 1;
  context.font = "10.5px system-ui, sans-serif";
  context.textAlign = "center";
  const top = 10 ** Math.floor(Math.log10(largest));
  let last = Number.POSITIVE_INFINITY;
  for (const value of [top, top / 10, top / 100]) {
    const r = scale * radius(value);
    // Room for the numbers below the base line.
    if (r > reach || r < 22 || last - r < 30) continue;
    last = r;
    context.beginPath();
    context.arc(x0, y0, r, Math.PI, 2 * Math.PI);
    context.stroke();
    context.fillText(
      value >= 0.001 && value < 10000 ? String(Number(value.toPrecision(1))) : value.toExponential(0),
      x0 - r,
      y0 + 13,
    );
  }
  context.beginPath();
  context.moveTo(x0 - reach, y0);
  context.lineTo(x0 + reach, y0);
  context.moveTo(x0, y0);
  context.lineTo(x0, y0 - reach);
  context.stroke();
  context.textAlign = "right";
  context.fillText("1/sr, cube root", x0 + reach, y0 + 13);
}

function drawRay(
  context: CanvasRenderingContext2D,
  x0: number,
  y0: number,
  reach: number,
  theta: number,
): void {
  const [x, y] = [x0 + reach * Math.sin(theta), y0 - reach * Math.cos(theta)];
  context.strokeStyle = context.fillStyle = style(context.canvas, "--accent");
  context.setLineDash([3, 3]);
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(x0, y0);
  context.stroke();
  context.setLineDash([]);
  context.beginPath();
  context.arc(x, y, 3.5, 0, 2 * Math.PI);
  context.fill();
}

/** theta_d over theta_h at one phi_d: the picture of B. Burley, "Physically-Based Shading at Disney", 2012, section 3. */
function drawSlice(
  context: CanvasRenderingContext2D,
  { width, height }: Size,
  parts: readonly Part[],
  phi: number,
): void {
  const [axisH, axisD, axisP] = parts[0]![0].grid;
  const column = Math.min(axisP.size - 1, Math.floor((phi / 180) * axisP.size));
  const image = new ImageData(axisH.size, axisD.size);
  for (let h = 0; h < axisH.size; h++) {
    for (let d = 0; d < axisD.size; d++) {
      const rgb = mixed(parts, (table) => sample(table, h, d, column));
      const at = 4 * ((axisD.size - 1 - d) * axisH.size + h);
      // White at 1/sr of a white matte surface, as in the published slices.
      rgb.forEach((value, c) => {
        image.data[at + c] = toByte(Math.PI * value);
      });
      image.data[at + 3] = 255;
    }
  }
  const cell = document.createElement("canvas");
  cell.width = axisH.size;
  cell.height = axisD.size;
  cell.getContext("2d")!.putImageData(image, 0, 0);
  const side = Math.min(height - 22, width - 40);
  const x0 = (width - side) / 2;
  context.imageSmoothingEnabled = false;
  context.drawImage(cell, x0, 2, side, side);
  context.imageSmoothingEnabled = true;
  context.fillStyle = style(context.canvas, "--quiet");
  context.font = "10.5px system-ui, sans-serif";
  context.textAlign = "center";
  context.fillText("θₕ  0 to 90° (square root)", width / 2, side + 16);
  context.save();
  context.translate(x0 - 7, 2 + side / 2);
  context.rotate(-Math.PI / 2);
  context.fillText("θ_d  0 to 90°", 0, 0);
  context.restore();
}
