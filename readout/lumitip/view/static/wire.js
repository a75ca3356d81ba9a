// What comes from the server; the form is told in view/wire.py.

const FRAMES = 1;
const CONTACT_FIELDS = 20;
const NOT_A_NUMBER = 65535;
const SHAPES = ["none", "edge", "corner", "cable", "covered"];

/** A message of frames: arrays with one entry a frame, `values` one row a frame. */
export function decode(buffer) {
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

/** Contact with `null` for what does not apply; points are [x, y] in mm, angles in degrees. */
function contactOf(f, markers) {
  const told = (i, make) => (Number.isNaN(f[i]) ? null : make());
  return {
    shape: SHAPES[f[0]],
    threshold: told(1, () => f[1]),
    contrast: told(2, () => f[2]),
    centre: told(3, () => [f[3], f[4]]),
    line: told(5, () => ({ point: [f[5], f[6]], angle: f[7], rms: f[8] })),
    corner: told(9, () => ({
      vertex: [f[9], f[10]], directions: [f[11], f[12]], opening: f[13], rms: f[14],
    })),
    cable: told(15, () => ({ point: [f[15], f[16]], angle: f[17], width: f[18], rms: f[19] })),
    markers,
  };
}
