// The socket to the board: requests go out, messages and frames come in.

import { decode } from "./frame.js";

export class Link {
  #listeners = new Map();
  #socket = null;
  #token;
  #pause = 250;

  constructor(token) {
    this.#token = token;
    document.addEventListener("visibilitychange", () => this.#rate());
  }

  /** Calls back for each message of a kind; `frame` for frames, `state` for whether there is a board. */
  on(kind, listener) {
    if (!this.#listeners.has(kind)) this.#listeners.set(kind, []);
    this.#listeners.get(kind).push(listener);
  }

  /** Asks for something. */
  ask(what, more = {}) {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify({ do: what, ...more }));
  }

  connect() {
    const socket = new WebSocket(`ws://${location.host}/socket?token=${encodeURIComponent(this.#token)}`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.#pause = 250;
      this.#tell("state", true);
      this.#rate();
    };
    socket.onmessage = ({ data }) => {
      if (typeof data !== "string") return this.#tell("frame", decode(data));
      const message = JSON.parse(data);
      this.#tell(message.kind, message);
    };
    socket.onclose = () => {
      this.#tell("state", false);
      setTimeout(() => this.connect(), this.#pause);
      this.#pause = Math.min(this.#pause * 2, 4000);
    };
    this.#socket = socket;
  }

  /** A page that nobody sees needs no frames. */
  #rate() {
    this.ask("rate", { frames: document.hidden ? 1 : 30 });
  }

  #tell(kind, value) {
    for (const listener of this.#listeners.get(kind) ?? []) listener(value);
  }
}
