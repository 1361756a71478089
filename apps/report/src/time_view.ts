// The stretch of time that all plots over time show, and the event that is marked in them.

export interface Range {
  low: number;
  high: number;
}
export interface Marked {
  start: number;
  end: number;
}

export interface TimeView {
  readonly full: Range;
  readonly events: readonly Marked[]; // shaded
  setEvents(events: readonly Marked[]): void;
  range(): Range;
  marked(): Marked | null;
  show(range: Range, marked?: Marked | null): void;
  reset(): void;
  listen(listener: () => void): () => void; // gives what ends it
  // A reader pointed at a time: chooses what is there, give or take.
  choose(time: number, give: number): void;
  onChoose(listener: (time: number, give: number) => void): void;
}

// Keeps `range` inside `full` and no shorter than a millionth of it.
export function clamped(range: Range, full: Range): Range {
  const length = Math.min(Math.max(range.high - range.low, (full.high - full.low) * 1e-6), full.high - full.low);
  const low = Math.min(Math.max(range.low, full.low), full.high - length);
  return { low, high: low + length };
}

// The event with as much before and after it as it is long, at least a few samples.
export function around(event: Marked, interval: number): Range {
  const margin = Math.max(event.end - event.start, 5 * interval);
  return { low: event.start - margin, high: event.end + margin };
}

export function makeTimeView(full: Range, shaded: readonly Marked[]): TimeView {
  const listeners = new Set<() => void>();
  let events = shaded;
  let chooser: (time: number, give: number) => void = () => {};
  let range = full;
  let marked: Marked | null = null;
  const tell = (): void => listeners.forEach((listener) => listener());
  return {
    full,
    get events() { return events; },
    setEvents(wanted) {
      events = wanted;
      marked = null;
      tell();
    },
    choose: (time, give) => chooser(time, give),
    onChoose(listener) {
      chooser = listener;
    },
    range: () => range,
    marked: () => marked,
    show(wanted, mark) {
      range = clamped(wanted, full);
      if (mark !== undefined) marked = mark;
      tell();
    },
    reset() {
      range = full;
      marked = null;
      tell();
    },
    listen(listener) {
      listeners.add(listener);
      return () => void listeners.delete(listener);
    },
  };
}
