// The way of the tool, as a picture that stays: where nothing but the tool has moved, only what is new is drawn.

const KEPT = 30_000;
/** Points that are nearer to the last one on the screen add nothing, in pixels. */
const NEAR = 0.5;

export class Trail {
  #ring = new Float64Array(KEPT * 4);
  // Points are counted from the first that ever was; the ring has those from `begin` to `end`.
  #begin = 0;
  #end = 0;
  #box = empty();
  #layer = document.createElement("canvas");
  #drawn = 0;
  #last = null;
  #known = "";

  /** Forgets everything. */
  clear() {
    this.#begin = this.#end = 0;
    this.#box = empty();
    this.#known = "";
  }

  /** Adds where the tool is at a tick; whether that is a new place. */
  add(tick, point) {
    const [, ...last] = this.#end > this.#begin ? this.#at(this.#end - 1) : [];
    if (last.length && point.every((value, dimension) => last[dimension] === value)) return false;
    this.#ring.set([tick, ...point], (this.#end++ % KEPT) * 4);
    this.#begin = Math.max(this.#begin, this.#end - KEPT);
    this.#widen(point);
    return true;
  }

  /** Drops what is later than a tick. */
  cut(tick) {
    while (this.#end > this.#begin && this.#at(this.#end - 1)[0] > tick) this.#end--;
    this.#box = empty();
    for (let index = this.#begin; index < this.#end; index++) this.#widen(this.#at(index).subarray(1));
    this.#known = "";
  }

  /** The lowest and the highest place in each dimension; without any, infinities. */
  get box() {
    return this.#box.map((range) => [...range]);
  }

  /** Draws it with `at`, which puts a place on the screen; `known` is equal for an equal `at`. */
  draw(context, at, known, color) {
    const { width, height } = context.canvas;
    const to = this.#layer.getContext("2d");
    const key = JSON.stringify([known, width, height, color]);
    if (key !== this.#known) {
      // It is empty after that.
      [this.#layer.width, this.#layer.height] = [width, height];
      [this.#known, this.#drawn, this.#last] = [key, this.#begin, null];
    }
    to.setTransform(context.getTransform());
    to.strokeStyle = color;
    to.lineWidth = 1.6;
    to.lineCap = "round";
    to.beginPath();
    if (this.#last) to.moveTo(...this.#last);
    for (; this.#drawn < this.#end; this.#drawn++) {
      const [x, y] = at(this.#at(this.#drawn).subarray(1));
      if (!this.#last) to.moveTo(x, y);
      else if (Math.abs(x - this.#last[0]) + Math.abs(y - this.#last[1]) < NEAR) continue;
      else to.lineTo(x, y);
      this.#last = [x, y];
    }
    to.stroke();
    context.save();
    context.resetTransform();
    context.drawImage(this.#layer, 0, 0);
    context.restore();
  }

  #at(index) {
    const from = (index % KEPT) * 4;
    return this.#ring.subarray(from, from + 4);
  }

  #widen(point) {
    point.forEach((value, dimension) => {
      const range = this.#box[dimension];
      range[0] = Math.min(range[0], value);
      range[1] = Math.max(range[1], value);
    });
  }
}

function empty() {
  return Array.from({ length: 3 }, () => [Infinity, -Infinity]);
}
