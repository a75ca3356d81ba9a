// Messages of the server. Each is acknowledged once it is drawn, which lets the next ones through;
// flow control is described in view/session.py, the messages in view/wire.py.

const RETRY_MS = [300, 600, 1200, 2500, 5000];
const FRAMES = 1;
const CONTACT_FIELDS = 20;
const NOT_A_NUMBER = 65535;
const SHAPES = ["none", "edge", "corner", "cable", "covered"];

export class Stream {
  /** `receiver` is an object with `frames(message)`, `estimate(estimate)`, `status(status)` and
   * `open(whether, why)`. */
  constructor(receiver) {
    this.receiver = receiver;
    this.tries = 0;
    this.drawn = {};
    this.answer = false;
    this.refusal = "";
    this.connect();
  }

  connect() {
    const socket = new WebSocket(`ws://${location.host}/stream`);
    socket.binaryType = "arraybuffer";
    let opened = false;
    socket.onopen = () => {
      opened = true;
      this.refusal = "";
      this.tries = 0;
      this.drawn = {};
      this.answer = false;
      this.receiver.open(true);
    };
    socket.onmessage = ({ data }) => this.take(data);
    socket.onclose = () => {
      this.receiver.open(false, this.refusal);
      if (!opened) this.askWhy(socket);
      setTimeout(() => this.connect(), RETRY_MS[Math.min(this.tries, RETRY_MS.length - 1)]);
      this.tries += 1;
    };
    this.socket = socket;
  }

  /** A browser does not say why a stream was refused; the server does. */
  async askWhy(socket) {
    const answer = await fetch("stream").catch(() => null);
    const why = answer && !answer.ok ? (await answer.text()).trim() : "";
    if (this.socket.readyState === WebSocket.OPEN) return; // a later try went through
    this.refusal = why;
    if (this.socket === socket && why) this.receiver.open(false, why);
  }

  take(data) {
    if (typeof data === "string") {
      const message = JSON.parse(data);
      if (message.estimate) {
        this.drawn[message.estimate.finger] = message.estimate.number;
        this.receiver.estimate(message.estimate);
      } else {
        this.answer = true;
        this.receiver.status(message);
      }
      return;
    }
    const message = decode(data);
    this.drawn[message.finger] = message.number;
    this.receiver.frames(message);
  }

  /** Acknowledge all messages so far. */
  acknowledge() {
    if (this.socket.readyState !== WebSocket.OPEN) return;
    if (!this.answer && !Object.keys(this.drawn).length) return;
    this.socket.send(JSON.stringify({ drawn: this.drawn, status: this.answer }));
    this.drawn = {};
    this.answer = false;
  }
}

/** Send a request; returns the answer, throws its error. */
export async function post(path, body = {}) {
  const answer = await fetch(path, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(body),
  });
  const result = await answer.json().catch(() => ({ error: `${path}: ${answer.status}` }));
  if (!answer.ok) throw new Error(result.error);
  return result;
}

/** Address of a recording, to download. */
export const fileOf = (name) => `api/recordings/${encodeURIComponent(name)}`;

export async function get(path) {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(`${path}: ${answer.status} ${await answer.text()}`);
  return answer.json();
}

/** Decode a message of frames: arrays with one entry, or row of `values`, per frame. */
function decode(buffer) {
  const head = new DataView(buffer);
  if (head.getUint8(0) !== FRAMES) throw new Error(`message of kind ${head.getUint8(0)}`);
  const frames = head.getUint16(4, true);
  const cells = head.getUint16(6, true);
  const markers = head.getUint16(8, true);
  let at = 24;
  const next = (type, length) => {
    const array = new type(buffer, at, length);
    at += array.byteLength;
    return array;
  };
  const t = next(Float64Array, frames);
  const fields = next(Float32Array, CONTACT_FIELDS);
  const points = next(Float32Array, 2 * markers);
  const seq = next(Uint32Array, frames);
  const codes = next(Uint16Array, frames * cells);
  const values = Float32Array.from(codes, (c) => (c === NOT_A_NUMBER ? NaN : c / 256));
  return {
    finger: head.getUint16(2, true),
    number: head.getUint32(12, true),
    skipped: head.getUint32(16, true),
    frames, cells, t, seq, values,
    contact: contactOf(fields, points),
  };
}

/** Contact with `null` for fields that do not apply; points [x, y] in mm, angles in degrees. */
function contactOf(f, markers) {
  const field = (i, make) => (Number.isNaN(f[i]) ? null : make());
  return {
    shape: SHAPES[f[0]],
    threshold: field(1, () => f[1]),
    contrast: field(2, () => f[2]),
    centre: field(3, () => [f[3], f[4]]),
    line: field(5, () => ({ point: [f[5], f[6]], angle: f[7], rms: f[8] })),
    corner: field(9, () => ({
      vertex: [f[9], f[10]], directions: [f[11], f[12]], opening: f[13], rms: f[14],
    })),
    cable: field(15, () => ({ point: [f[15], f[16]], angle: f[17], width: f[18], rms: f[19] })),
    markers,
  };
}
