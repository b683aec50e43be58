// A frame from the board as an object; the layout is described in src/board/frame.rs.

const AXES = 56, AXIS = 72, BITS = 632, DIRECTIONS = 888, ANALOG = 896, PERSIST = 928, LATER_AXES = 1728;

export function decode(buffer) {
  const view = new DataView(buffer);
  const flags = view.getUint32(4, true);
  const number = (at) => view.getFloat64(at, true);
  const width = view.getUint32(44, true), rows = view.getUint32(48, true), later = view.getUint32(52, true);
  const place = (index) => (index < 8 ? AXES + AXIS * index : LATER_AXES + AXIS * (index - 8));
  return {
    running: (flags & 1) !== 0,
    past: (flags & 2) !== 0,
    ended: (flags & 4) !== 0,
    tick: number(8),
    end: number(16),
    asked: number(24),
    measured: number(32),
    generation: view.getUint32(40, true),
    width,
    rows,
    samples: new Float64Array(buffer, LATER_AXES + AXIS * later, width * rows),
    axes: Array.from({ length: 8 + later }, (_, index) => axis(view, place(index))),
    bit: (bit) => (view.getUint8(BITS + (bit >> 3)) >> (bit & 7)) & 1,
    isOutput: (bit) => bit < 64 && ((view.getUint8(DIRECTIONS + (bit >> 3)) >> (bit & 7)) & 1) === 1,
    adc: (index) => view.getInt16(ANALOG + 2 * index, true),
    dac: (index) => view.getInt16(ANALOG + 16 + 2 * index, true),
    persist: new DataView(buffer, PERSIST, 800),
  };
}

function axis(view, at) {
  const number = (index) => view.getFloat64(at + 8 * index, true);
  const byte = (index) => view.getUint8(at + 64 + index);
  return {
    dest: number(0), position: number(1), load: number(2), output: number(3),
    negative: number(5), positive: number(6), vel: number(7),
    enabled: byte(0) !== 0, input: byte(1), mode: byte(2),
    atNegative: (byte(3) & 1) !== 0, atPositive: (byte(3) & 2) !== 0,
    hasFeedback: byte(1) !== 0,
  };
}
