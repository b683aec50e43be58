// The socket to the board: requests go out, messages and frames come in.

import { decode } from "./frame.js";

export class Link {
  #listeners = new Map();
  #socket = null;
  #token;
  #pause = 250;
  #version = null;
  #beforeAction = () => {};

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
    if (what !== "goto") this.#beforeAction();
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify({ do: what, ...more }));
  }

  /** Calls this before anything but a way through time is sent: what was asked for earlier is done earlier. */
  before(listener) {
    this.#beforeAction = listener;
  }

  connect() {
    let isOpen = false;
    const socket = new WebSocket(`ws://${location.host}/socket?token=${encodeURIComponent(this.#token)}`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.#pause = 250;
      isOpen = true;
      this.#tell("state", true);
      this.#rate();
    };
    socket.onmessage = ({ data }) => {
      if (typeof data !== "string") return this.#tell("frame", decode(data));
      const message = JSON.parse(data);
      if (message.kind === "hello" && this.#isOther(message.version)) return location.reload();
      this.#tell(message.kind, message);
    };
    socket.onclose = () => {
      this.#tell("state", false);
      if (!isOpen) this.#look();
      setTimeout(() => this.connect(), this.#pause);
      this.#pause = Math.min(this.#pause * 2, 4000);
    };
    this.#socket = socket;
  }

  /** Another cc67 may answer here by now: its page is another one. */
  #isOther(version) {
    const isOther = this.#version !== null && this.#version !== version;
    this.#version = version;
    return isOther;
  }

  /** Whether a server is here that does not let this page in. */
  async #look() {
    const answer = await fetch(location.href).catch(() => null);
    if (answer?.status === 403) this.#tell("refused", true);
  }

  /** A page that nobody sees needs no frames. */
  #rate() {
    this.ask("rate", { frames: document.hidden ? 1 : 30 });
  }

  #tell(kind, value) {
    for (const listener of this.#listeners.get(kind) ?? []) listener(value);
  }
}
