// A line of few corners from left to right: a stroke costs by its corners, and most samples lie between their neighbours.

/** How far a point may lie from a line that leaves it out, in pixels. */
const TOLERANCE = 0.15;

export class Pen {
  #context;
  #from = null;
  #to = null;
  #low = 0;
  #high = 0;

  constructor(context) {
    this.#context = context;
  }

  to(x, y) {
    if (!this.#from) {
      this.#context.moveTo(x, y);
      this.#from = this.#to = { x, y };
      this.#open();
      return;
    }
    const slope = (y - this.#from.y) / (x - this.#from.x);
    if (!(x > this.#from.x && slope >= this.#low && slope <= this.#high)) {
      this.end();
      this.#from = this.#to;
      this.#open();
    }
    this.#to = { x, y };
    const width = x - this.#from.x;
    // Nothing lies on an upright line but its ends.
    this.#low = width > 0 ? Math.max(this.#low, (y - TOLERANCE - this.#from.y) / width) : Infinity;
    this.#high = width > 0 ? Math.min(this.#high, (y + TOLERANCE - this.#from.y) / width) : -Infinity;
  }

  /** Draws what is left out so far. */
  end() {
    if (this.#to !== this.#from) this.#context.lineTo(this.#to.x, this.#to.y);
  }

  #open() {
    [this.#low, this.#high] = [-Infinity, Infinity];
  }
}
