// The last values of one finger: rings of fixed size.

const MOST_FRAMES = 16384; // 82 s at 200 Hz
const MOST_VALUES = 4_000_000;

export class History {
  constructor(cells) {
    this.cells = cells;
    this.size = Math.max(256, Math.min(MOST_FRAMES, Math.floor(MOST_VALUES / cells)));
    this.t = new Float64Array(this.size);
    this.mean = new Float32Array(this.size);
    this.least = new Float32Array(this.size);
    this.most = new Float32Array(this.size);
    this.values = new Float32Array(this.size * cells);
    this.clear();
  }

  clear() {
    this.count = 0;
    this.last = -Infinity;
  }

  /** Take the frames of a message; a time that goes back is another run. */
  take({ t, values, frames }) {
    for (let i = 0; i < frames; i += 1) {
      if (t[i] < this.last) this.clear();
      this.last = t[i];
      const at = this.count % this.size;
      const row = values.subarray(i * this.cells, (i + 1) * this.cells);
      let [sum, least, most, number] = [0, Infinity, -Infinity, 0];
      for (const value of row) {
        if (Number.isNaN(value)) continue;
        sum += value;
        number += 1;
        if (value < least) least = value;
        if (value > most) most = value;
      }
      this.t[at] = t[i];
      this.mean[at] = number ? sum / number : NaN;
      this.least[at] = least;
      this.most[at] = most;
      this.values.set(row, at * this.cells);
      this.count += 1;
    }
  }

  /** Places in the rings of the frames since `from` (s), oldest first. */
  *since(from) {
    const kept = Math.min(this.count, this.size);
    let low = this.count - kept;
    let high = this.count;
    while (low < high) {
      const half = (low + high) >> 1;
      if (this.t[half % this.size] < from) low = half + 1;
      else high = half;
    }
    for (let i = low; i < this.count; i += 1) yield i % this.size;
  }
}
