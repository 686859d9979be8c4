// A store: one value, replaced whole; listeners hear of the parts they chose.

export interface Store<T> {
  readonly get: () => T;
  /** Replace some fields; listeners run once, afterwards. */
  readonly set: (change: Partial<T>) => void;
  /** Run `listener` now and whenever what `select` gives changes. */
  readonly watch: <S>(select: (state: T) => S, listener: (selected: S) => void) => void;
}

export function createStore<T extends object>(initial: T): Store<T> {
  let state = initial;
  const watchers: (() => void)[] = [];
  return {
    get: () => state,
    set: (change) => {
      state = { ...state, ...change };
      for (const watcher of watchers) watcher();
    },
    watch: (select, listener) => {
      let last = select(state);
      watchers.push(() => {
        const next = select(state);
        if (same(last, next)) return;
        last = next;
        listener(next);
      });
      listener(last);
    },
  };
}

/** Equal, or arrays of equal things: a selector may give several parts at once. */
function same(a: unknown, b: unknown): boolean {
  if (Array.isArray(a) && Array.isArray(b))
    return a.length === b.length && a.every((x, i) => Object.is(x, b[i]));
  return Object.is(a, b);
}
