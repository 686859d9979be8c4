// The shortlist: materials that a person kept, with a name and a note, in the browser and in a file.
//
//   {"format": 1, "library": ..., "materials": [{"name", "note", "recipe", "link"}, ...]}

import { Problem } from "./api/client";
import type { LibrarySummary, RecipeDocument } from "./api/schema";
import { bodyScale, LINEAR } from "./blend";
import { fromDocument, type Ingredient, namesIn } from "./recipe";

export interface Kept {
  readonly id: string;
  readonly name: string;
  readonly note: string;
  readonly recipe: RecipeDocument;
  /** The fragment of the address where it was kept; empty for one from elsewhere. */
  readonly link: string;
}

export function keptOf(name: string, recipe: RecipeDocument, link: string, note = ""): Kept {
  return { id: Math.random().toString(36).slice(2), name, note, recipe, link };
}

export function toText(library: string, kept: readonly Kept[]): string {
  const materials = kept.map(({ name, note, recipe, link }) => ({ name, note, recipe, link }));
  return `${JSON.stringify({ format: 1, library, materials }, null, 1)}\n`;
}

/** Whether a text is a shortlist, of however many. */
export function isShortlist(text: string): boolean {
  return Array.isArray(parsed(text, "").materials);
}

/** What is in a file of a shortlist, or of one recipe, called `file`. */
export function fromText(text: string, file: string, library: LibrarySummary): Kept[] {
  const document = parsed(text, file);
  const stem = file.replace(/\.json$/i, "");
  if (Array.isArray(document.materials))
    return document.materials.map((each: Partial<Kept>) =>
      keptOf(each.name ?? stem, checked(each.recipe, file, library), each.link ?? "", each.note),
    );
  const recipe = checked(document, file, library);
  const missing = missingIn(
    recipe,
    library.materials.map(({ name }) => name),
  );
  if (missing.length)
    throw new Problem(`${file} needs ${missing.join(", ")}, which ${library.name} does not have.`);
  return [keptOf(stem, recipe, "")];
}

/** What a recipe needs, and is not among `names`: a measurement of a person's own that was not dropped in again. */
export function missingIn(recipe: RecipeDocument, names: readonly string[]): string[] {
  return namesIn(fromDocument(recipe)).filter((name) => !names.includes(name));
}

function parsed(text: string, file: string) {
  try {
    return Object(JSON.parse(text));
  } catch {
    throw new Problem(`${file} is no JSON: expected a recipe, or a shortlist that this page saved.`);
  }
}

function checked(recipe: unknown, file: string, library: LibrarySummary): RecipeDocument {
  // Without a blend it is linear, as in Python.
  const { weights, body_scale, blend = LINEAR, ...rest } = Object(recipe);
  const document: RecipeDocument = {
    library: rest.library,
    blend,
    weights,
    ...(body_scale && { body_scale }),
  };
  if (typeof document.weights !== "object" || document.weights === null)
    throw new Problem(`${file} has no weights: expected a recipe, or a shortlist that this page saved.`);
  if (document.library !== library.name)
    throw new Problem(
      `${file} is of the library ${document.library}, and this is ${library.name}: open that one with \`halfway view\`.`,
    );
  if (!library.blends.includes(document.blend))
    throw new Problem(
      `${file} blends by ${document.blend}: this page draws ${library.blends.join(", ")}. \`halfway render\` draws it.`,
    );
  if (bodyScale(document) && !library.recolours)
    throw new Problem(
      `${file} has its body scaled, which takes a server: this page draws mixes alone. \`halfway render\` draws it.`,
    );
  return document;
}

/** The material's weights. */
export function recipeOf({ recipe }: Kept): Ingredient[] {
  return fromDocument(recipe);
}
