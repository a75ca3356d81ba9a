// The stream from the server: each message is answered once it is drawn, which is what lets the
// next ones through; see view/session.py.

import { decode } from "./wire.js";

const AGAIN_MS = [300, 600, 1200, 2500, 5000];

export class Stream {
  /** `heard` is an object with `frames(message)`, `status(status)` and `open(whether)`. */
  constructor(heard) {
    this.heard = heard;
    this.tries = 0;
    this.drawn = {};
    this.answer = false;
    this.connect();
  }

  connect() {
    const socket = new WebSocket(`ws://${location.host}/stream`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.tries = 0;
      this.drawn = {};
      this.answer = false;
      this.heard.open(true);
    };
    socket.onmessage = ({ data }) => this.take(data);
    socket.onclose = () => {
      this.heard.open(false);
      setTimeout(() => this.connect(), AGAIN_MS[Math.min(this.tries, AGAIN_MS.length - 1)]);
      this.tries += 1;
    };
    this.socket = socket;
  }

  take(data) {
    if (typeof data === "string") {
      this.heard.status(JSON.parse(data));
      this.answer = true;
      return;
    }
    const message = decode(data);
    this.drawn[message.finger] = message.number;
    this.heard.frames(message);
  }

  /** Say that everything taken so far is drawn. */
  acknowledge() {
    if (this.socket.readyState !== WebSocket.OPEN) return;
    if (!this.answer && !Object.keys(this.drawn).length) return;
    this.socket.send(JSON.stringify({ drawn: this.drawn, status: this.answer }));
    this.drawn = {};
    this.answer = false;
  }
}

/** Ask the server to do something; returns what it says, throws what went wrong. */
export async function post(path, told = {}) {
  const answer = await fetch(path, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(told),
  });
  const said = await answer.json().catch(() => ({ error: `${path}: ${answer.status}` }));
  if (!answer.ok) throw new Error(said.error);
  return said;
}

export async function get(path) {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(`${path}: ${answer.status} ${await answer.text()}`);
  return answer.json();
}
