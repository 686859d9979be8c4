// Looking before choosing: what the pointer rests on is drawn on the object, until it leaves, or something else happens.

import { PLAIN } from "./blend";
import type { Context } from "./context";
import { fromDocument, only } from "./recipe";
import type { Ghost, Pointed, State } from "./state";

/** Milliseconds that the pointer rests before. */
const REST = 180;

/** A material of the library, to be looked at. */
export function materialAsGhost(name: string): Ghost {
  return { name, recipe: only(name), ...PLAIN };
}

export function followPointer(context: Context): void {
  const { store, actions, signal } = context;
  let timer: ReturnType<typeof setTimeout> | undefined;
  let asking = new AbortController();
  signal.addEventListener("abort", () => clearTimeout(timer));
  const show = (ghost: Ghost | null) => store.set({ ghost, ghostMixed: [] });
  store.watch(["pointed"], ({ pointed, ghost }) => {
    clearTimeout(timer);
    asking.abort();
    asking = new AbortController();
    const { signal: moved } = asking;
    if (pointed === null && ghost !== null) show(null);
    if (pointed === null) return;
    timer = setTimeout(() => {
      resolved(context, pointed, moved).then(show, (error: Error) => {
        if (error.name !== "AbortError") actions.say("space", "pointed", error.message);
      });
    }, REST);
  });
  // What was done is to be seen, and not what the pointer is still on.
  const acted: readonly (keyof State)[] = ["stops", "t", "point", "asked", "held", "space", "blend"];
  store.watch(acted, ({ pointed }) => pointed && store.set({ pointed: null }));
}

/** The material at a point is asked for; beyond all mixes the one nearby, where the dot would go. */
async function resolved({ client, store }: Context, pointed: Pointed, moved: AbortSignal): Promise<Ghost> {
  if (!("point" in pointed)) return pointed;
  const { space, blend } = store.get();
  const { recipe, inside } = await client.at(space, blend, pointed.point, moved);
  moved.throwIfAborted();
  return { name: inside ? "here" : "nearest mix", recipe: fromDocument(recipe), blend: recipe.blend };
}
