// The optical twin of the fingertip: the same tables and raster as `lumitip.twin` in Python.
class Twin {
  constructor({ x_mm: xs, y_mm: ys, holes, model }) {
    [this.xs, this.ys, this.holes, this.model] = [xs, ys, holes, model];
    this.tables = new Map();
    const kinds = new Map();
    this.seen = xs.map((x, cell) => {
      const kept = [];
      for (let led = 0; led < xs.length; led += 1) {
        const shift = [xs[led] - x, ys[led] - ys[cell]];
        if (Math.hypot(...shift) > OPTICS.reach_mm) continue;
        const rounded = shift.map((v) => Math.round(v * 1000) / 1000 + 0);
        const sizes = [holes[led], holes[cell]];
        const key = [...rounded, ...sizes].join();
        if (!kinds.has(key)) kinds.set(key, { index: kinds.size, shift: rounded, holes: sizes });
        kept.push(kinds.get(key).index);
      }
      return kept.sort((a, b) => a - b);
    });
    const ways = [...kinds.values()];
    const rough = ways.map((way) => bundleOf(model, way, OPTICS.few));
    const lights = rough.map((rays) => sum(rays[4]));
    const least = OPTICS.dim * Math.max(...lights);
    const fine = (light) => light > least && ways.length <= OPTICS.many;
    this.bundles = ways.map((way, kind) =>
      (fine(lights[kind]) ? bundleOf(model, way, OPTICS.across) : rough[kind]));
    this.light = this.bundles.map((rays) => sum(rays[4]));
    this.full = this.seen.map((kept) => sum(kept.map((kind) => this.light[kind])));
    const most = Math.max(...this.full);
    this.drive = this.full.map((light) => (model.gain * light) / most);
    this.curve = this.curveOf(model.knee_v / model.supply_v);
    this.empty = this.drive.map((drive) => this.read(drive));
  }

  // Photocurrent and value, growing, from the circuit's equation.
  curveOf(knee) {
    const low = Array.from({ length: 1499 }, (_, i) => 1e-4 * knee * 1e4 ** (i / 1499));
    const high = Array.from({ length: 3000 }, (_, i) => knee + ((1 - knee) * i) / 2999);
    const voltage = [...low, ...high].reverse();
    return {
      drive: voltage.map((v) => (1 - v) / -Math.expm1(-v / knee)),
      value: voltage.map((v) => FULL * (1 - v)),
    };
  }

  read(drive) {
    const { drive: drives, value } = this.curve;
    if (drive <= drives[0]) return value[0];
    let [low, high] = [0, drives.length - 1];
    if (drive >= drives[high]) return value[high];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (drives[middle] <= drive) low = middle;
      else high = middle;
    }
    const share = (drive - drives[low]) / (drives[high] - drives[low]);
    return value[low] + share * (value[high] - value[low]);
  }

  get spots() {
    this.spotted ||= this.bundles.map((rays) => spotsOf(this.model, rays));
    return this.spotted;
  }

  table(diameter) {
    if (!this.tables.has(diameter)) {
      if (this.tables.size > 8) this.tables.delete([...this.tables.keys()].find(Boolean));
      this.tables.set(diameter, this.tableOf(diameter));
    }
    return this.tables.get(diameter);
  }

  // Share of light that a half-plane (diameter 0) or a cable takes, by direction and distance.
  tableOf(diameter) {
    const half = diameter / 2;
    const height = OPTICS.height * this.model.gap_mm;
    const places = diameter
      ? this.bundles.map(([x, y, a, b, light]) => ({ a, b, light,
        x: x.map((v, i) => v + height * a[i]), y: y.map((v, i) => v + height * b[i]) }))
      : this.spots;
    let far = 0;
    for (const { x, y, a, b } of places) {
      for (let i = 0; i < x.length; i += 1) {
        const wide = diameter ? half * Math.sqrt(1 + a[i] * a[i] + b[i] * b[i]) : 0;
        far = Math.max(far, Math.hypot(x[i], y[i]) + wide);
      }
    }
    const reach = (Math.ceil(far / OPTICS.step_mm) + 1 + SOFT) * OPTICS.step_mm;
    const entries = 2 * Math.round(reach / OPTICS.step_mm) + 1;
    const names = this.seen.map((kept) => kept.join());
    const sets = [...new Set(names)];
    const row = names.map((name) => sets.indexOf(name));
    const members = sets.map((name) => this.seen[names.indexOf(name)]);
    const full = sets.map((name) => this.full[names.indexOf(name)]);
    const turns = 360 / OPTICS.step_deg;
    const shares = new Float32Array(sets.length * turns * entries);
    for (let turn = 0; turn < turns / 2; turn += 1) {
      const angle = (turn * OPTICS.step_deg * Math.PI) / 180;
      const taken = places.map((place) => this.taken(place, angle, half, reach, entries));
      for (let set = 0; set < sets.length; set += 1) {
        const one = (set * turns + turn) * entries;
        const other = (set * turns + turn + turns / 2) * entries;
        const light = new Float64Array(entries);
        for (const kind of members[set]) {
          for (let i = 0; i < entries; i += 1) light[i] += taken[kind][i];
        }
        for (let i = 0; i < entries; i += 1) {
          const share = light[i] / full[set];
          shares[one + i] = share;
          shares[other + entries - 1 - i] = diameter ? share : 1 - share;
        }
      }
    }
    return { shares, reach, entries, turns, row };
  }

  taken({ x, y, a, b, light }, angle, half, reach, entries) {
    const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
    const left = x.map((v, i) => y[i] * cos - v * sin);
    const steps = new Float64Array(entries);
    if (half) {
      const wide = a.map((v, i) => half * Math.sqrt(1 + (b[i] * cos - v * sin) ** 2));
      addSteps(left.map((v, i) => v - wide[i]), light, reach, entries, 1, steps);
      addSteps(left.map((v, i) => v + wide[i]), light, reach, entries, -1, steps);
    } else addSteps(left, light, reach, entries, 1, steps);
    return softened(steps);
  }

  ofLine({ x, y, angle_deg: degrees, diameter = 0 }) {
    const { shares, reach, entries, turns, row } = this.table(diameter);
    const angle = (degrees * Math.PI) / 180;
    const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
    const turn = degrees / OPTICS.step_deg;
    const down = turn - Math.floor(turn);
    const first = ((Math.floor(turn) % turns) + turns) % turns;
    return this.xs.map((cellX, cell) => {
      const left = (this.ys[cell] - y) * cos - (cellX - x) * sin;
      const way = Math.min(Math.max((left + reach) / OPTICS.step_mm, 0), entries - 1.001);
      const column = Math.trunc(way);
      const at = (which) => {
        const begin = (row[cell] * turns + which) * entries + column;
        return shares[begin] + (way - column) * (shares[begin + 1] - shares[begin]);
      };
      const [one, other] = [at(first), at((first + 1) % turns)];
      return 1 - (one + down * (other - one));
    });
  }

  // For each cell the pixels of the plane that its light crosses, with their shares of it.
  get plane() {
    if (this.planed) return this.planed;
    const pixel = Math.min(OPTICS.pixel_mm, (this.model.hole_mm * Math.min(...this.holes)) / 5);
    const cells = this.seen.map((kept, cell) => {
      const bins = new Map();
      for (const kind of kept) {
        const { x, y, light } = this.spots[kind];
        spread(x.map((v) => (v + this.xs[cell]) / pixel - 0.5),
          y.map((v) => (v + this.ys[cell]) / pixel - 0.5), light, (column, row, share) => {
            const key = column * 65536 + row;
            bins.set(key, (bins.get(key) || 0) + share / this.full[cell]);
          });
      }
      const lit = [...bins].filter(([, share]) => share > OPTICS.least);
      const scale = sum([...bins.values()]) / sum(lit.map(([, share]) => share));
      return lit.map(([key, share]) => {
        const column = Math.round(key / 65536);
        return [(column + 0.5) * pixel, (key - column * 65536 + 0.5) * pixel, share * scale];
      });
    });
    this.planed = { pixel, cells };
    return this.planed;
  }

  ofCorner({ x, y, angle_deg: degrees, opening_deg: opening = 90 }) {
    const { pixel, cells } = this.plane;
    const [angle, half] = [(degrees * Math.PI) / 180, (opening * Math.PI) / 360];
    const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
    const [wide, deep] = [Math.cos(half), Math.sin(half)];
    return cells.map((pixels) => {
      let light = 1;
      for (const [pixelX, pixelY, share] of pixels) {
        const [dx, dy] = [pixelX - x, pixelY - y];
        const away = Math.abs(dy * cos - dx * sin) * wide - (dx * cos + dy * sin) * deep;
        light -= share * Math.min(Math.max(0.5 - away / pixel, 0), 1);
      }
      return light;
    });
  }

  // Values of all cells, calibrated with the empty grasp, 0 to 255.
  values(shape) {
    const ways = { edge: () => this.ofLine({ ...shape, diameter: 0 }),
      cable: () => this.ofLine(shape), corner: () => this.ofCorner(shape) };
    const light = ways[shape.kind] ? ways[shape.kind]() : this.xs.map(() => 1);
    return light.map((share, cell) => {
      const value = (this.read(share * this.drive[cell]) * FULL) / this.empty[cell];
      return Math.min(Math.max(value, 0), FULL);
    });
  }
}
