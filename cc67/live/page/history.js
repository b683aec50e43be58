// The samples of the scope's signals: the last minutes, in a ring of fixed size.

/** Numbers that are kept: 24 MB. */
const KEPT = 3_000_000;

export class History {
  names = [];
  generation = -1;
  #width = 1;
  #rows = 1;
  #ring = new Float64Array(1);
  #first = 0;
  count = 0;

  /** Begins again with other signals. */
  reset(names, generation) {
    this.names = names;
    this.generation = generation;
    this.#width = names.length + 1;
    this.#rows = Math.floor(KEPT / this.#width);
    if (this.#ring.length !== this.#rows * this.#width) this.#ring = new Float64Array(this.#rows * this.#width);
    this.#first = this.count = 0;
  }

  /** Takes the samples of a frame. */
  add(frame) {
    if (frame.generation !== this.generation || frame.width !== this.#width) return;
    for (let row = 0; row < frame.rows; row++) {
      const at = ((this.#first + this.count) % this.#rows) * this.#width;
      this.#ring.set(frame.samples.subarray(row * this.#width, (row + 1) * this.#width), at);
      if (this.count < this.#rows) this.count++;
      else this.#first = (this.#first + 1) % this.#rows;
    }
  }

  /** Drops what is later than a tick. */
  cut(tick) {
    while (this.count && this.tick(this.count - 1) > tick) this.count--;
  }

  tick(row) {
    return this.#ring[((this.#first + row) % this.#rows) * this.#width];
  }

  value(row, signal) {
    return this.#ring[((this.#first + row) % this.#rows) * this.#width + 1 + signal];
  }

  /** The first row that is not before a tick. */
  find(tick) {
    let [low, high] = [0, this.count];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.tick(middle) < tick) low = middle + 1;
      else high = middle;
    }
    return low;
  }
}
