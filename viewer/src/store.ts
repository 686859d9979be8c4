// A store: one value, replaced whole; listeners hear of the fields they named.

export interface Store<T> {
  readonly get: () => T;
  /** Replace some fields; listeners run once, afterwards. */
  readonly set: (change: Partial<T>) => void;
  /** Run `listener` now and whenever one of these fields is another. */
  readonly watch: (fields: readonly (keyof T)[], listener: (state: T) => void) => void;
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
    watch: (fields, listener) => {
      let last = state;
      watchers.push(() => {
        const before = last;
        last = state;
        if (fields.some((field) => !Object.is(before[field], state[field]))) listener(state);
      });
      listener(state);
    },
  };
}
