// The whole shortlist as one zip: recipes, and tables or fits in the formats that are chosen.

import { strToU8, Zip, ZipDeflate } from "three/addons/libs/fflate.module.js";

import type { Context } from "../../context";
import { download, el, popover } from "../../dom";
import { type Kept, toText } from "../../shortlist";
import { fileName } from "../../title";
import { FORMATS } from "../recipe/exports";

export function takeAll(context: Context): HTMLElement {
  const { store, actions } = context;
  const boxes = store
    .get()
    .library.exports.map((format) => el("input", { type: "checkbox", name: "format", value: format }));
  const labels = boxes.map((box) => el("label.line", box, FORMATS[box.value]?.text ?? box.value));
  const save = el("button.button.main", { type: "button" }, "Save");
  const note = el("span.note", { role: "status" });
  const form = popover(
    "Take the shortlist home",
    el(
      "p.note",
      "A zip with the shortlist, which can be dropped on this page again anywhere, each recipe, and:",
    ),
    ...labels,
    el("div.line", save, note),
  );
  const say = (text: string) => {
    note.textContent = text;
  };
  save.addEventListener("click", async () => {
    save.disabled = true;
    try {
      const formats = boxes.filter((box) => box.checked).map((box) => box.value);
      download(await zipped(context, formats, say), "shortlist.zip");
      actions.say("route", "take", null);
    } catch (error) {
      actions.say("route", "take", (error as Error).message);
    }
    say("");
    save.disabled = false;
  });
  const open = el("button.button", { type: "button", onclick: () => form.togglePopover() }, "Take home …");
  return el("div.take", open, form);
}

async function zipped(
  { client, store }: Context,
  formats: readonly string[],
  say: (text: string) => void,
): Promise<Blob> {
  const { kept, library } = store.get();
  const parts: Uint8Array<ArrayBuffer>[] = [];
  const zip = new Zip((_, chunk) => parts.push(chunk as Uint8Array<ArrayBuffer>));
  const add = (name: string, content: Uint8Array) => {
    const file = new ZipDeflate(name, { level: 1 });
    zip.add(file);
    file.push(content, true);
  };
  add("shortlist.json", strToU8(toText(library.name, kept)));
  for (const [name, { recipe }] of named(kept)) {
    add(`${name}.json`, strToU8(`${JSON.stringify(recipe, null, 1)}\n`));
    for (const format of formats) {
      const path = `${name}${FORMATS[format]?.suffix ?? `.${format}`}`;
      say(path);
      const { file } = await client.exported(format, recipe);
      add(path, new Uint8Array(await file.arrayBuffer()));
    }
  }
  zip.end();
  return new Blob(parts, { type: "application/zip" });
}

/** Each under a file name of its own. */
function named(kept: readonly Kept[]): Map<string, Kept> {
  const names = new Map<string, Kept>();
  for (const each of kept) {
    const plain = fileName(each.name);
    let name = plain;
    for (let i = 2; names.has(name); i++) name = `${plain} (${i})`;
    names.set(name, each);
  }
  return names;
}
