// Rays of the optical twin: the same as those of `lumitip.twin` in Python.
const OPTICS = { reach_mm: 12.6, across: 6, few: 3, dim: 0.005, many: 60, kernel_mm: 0.1,
  pixel_mm: 0.5, step_mm: 0.05, step_deg: 3, patch_mm: 8, least: 1e-5, height: 0.5 };
const FULL = 255;
const SOFT = Math.round(OPTICS.pixel_mm / OPTICS.step_mm / 2);

function inHole(model, share = 1) {
  const apothem = (share * model.hole_mm) / 2 + 1e-9;
  if (model.hole_shape === "circle") return (x, y) => x * x + y * y <= apothem * apothem;
  return (x, y) => Math.abs(y) <= apothem
    && (Math.sqrt(3) / 2) * Math.abs(x) + 0.5 * Math.abs(y) <= apothem;
}

function holePoints(model, across) {
  const step = model.hole_mm / 2 / across;
  const half = Array.from({ length: Math.floor(1.2 * across) + 1 }, (_, i) => (i + 0.5) * step);
  const line = [...half.map((v) => -v).reverse(), ...half];
  const inside = inHole(model);
  return line.flatMap((y) => line.filter((x) => inside(x, y)).map((x) => [x, y]));
}

// Light that falls from a die on a hole, relative to that on one of the model's size.
function relativeLight(model, share, depth, exponent) {
  const held = (radius) => 1 - (1 + (radius / depth) ** 2) ** (-(exponent + 1) / 2);
  return held((share * model.hole_mm) / 2) / held(model.hole_mm / 2);
}

// Rays of an LED that is displaced from its detector, each behind a hole of its own size: x, y at
// the receiver's mask, slopes, weight.
function bundleOf(model, { shift: [dx, dy], holes: [own, other] }, across) {
  const points = holePoints(model, across);
  const die = { points: [[0, 0]], share: 1 - model.alpha };
  const holeOf = (size, depth, exponent) => ({
    points: points.map(([x, y]) => [size * x, size * y]), depth: 0,
    share: (model.alpha / points.length) * relativeLight(model, size, depth, exponent),
  });
  const ledHole = holeOf(own, model.emitter_depth_mm, model.led_exponent);
  const cellHole = holeOf(other, model.detector_depth_mm, model.detector_exponent);
  const [fromHole, toHole] = [inHole(model, own), inHole(model, other)];
  const power = (model.led_exponent + model.detector_exponent + 2) / 2;
  const rays = [];
  for (const source of [{ ...die, depth: model.emitter_depth_mm }, ledHole]) {
    for (const target of [{ ...die, depth: model.detector_depth_mm }, cellHole]) {
      const way = source.depth + model.gap_mm + target.depth;
      const light = (source.share * target.share) / (way * way);
      for (const [sx, sy] of source.points) {
        for (const [tx, ty] of target.points) {
          const [a, b] = [(sx + dx - tx) / way, (sy + dy - ty) / way];
          const [x, y] = [tx + a * target.depth, ty + b * target.depth];
          const above = fromHole(x + model.gap_mm * a - dx, y + model.gap_mm * b - dy);
          if (above && toHole(x, y)) rays.push([x, y, a, b, light * (1 + a * a + b * b) ** -power]);
        }
      }
    }
  }
  return [0, 1, 2, 3, 4].map((part) => Float64Array.from(rays, (ray) => ray[part]));
}

const sum = (values) => values.reduce((total, value) => total + value, 0);

// Light of points spread over the four places of a raster around each.
function spread(xs, ys, light, add) {
  for (let i = 0; i < xs.length; i += 1) {
    const [column, row] = [Math.floor(xs[i]), Math.floor(ys[i])];
    const [right, up] = [xs[i] - column, ys[i] - row];
    add(column, row, (1 - right) * (1 - up) * light[i]);
    add(column + 1, row, right * (1 - up) * light[i]);
    add(column, row + 1, (1 - right) * up * light[i]);
    add(column + 1, row + 1, right * up * light[i]);
  }
}

// Places where the rays of a bundle cross the plane of the object, gathered on a fine raster.
function spotsOf(model, [x, y, a, b, light]) {
  const height = OPTICS.height * model.gap_mm;
  const scale = 1 / OPTICS.kernel_mm;
  const bins = new Map();
  spread(x.map((v, i) => (v + height * a[i]) * scale), y.map((v, i) => (v + height * b[i]) * scale),
    light, (column, row, share) => {
      const key = column * 65536 + row;
      bins.set(key, (bins.get(key) || 0) + share);
    });
  const lit = [...bins].filter(([, share]) => share !== 0);
  const column = (key) => Math.round(key / 65536);
  return {
    x: Float64Array.from(lit, ([key]) => column(key) * OPTICS.kernel_mm),
    y: Float64Array.from(lit, ([key]) => (key - column(key) * 65536) * OPTICS.kernel_mm),
    light: Float64Array.from(lit, ([, share]) => share),
  };
}

// Light to the right of a line, for every distance of the cell to the left of it.
function addSteps(left, light, reach, entries, sign, into) {
  const bins = new Float64Array(entries + 1);
  for (let i = 0; i < left.length; i += 1) {
    const way = (left[i] + reach) / OPTICS.step_mm;
    const column = Math.trunc(way);
    const right = light[i] * (way - column);
    bins[column] += light[i] - right;
    bins[column + 1] += right;
  }
  let before = 0;
  for (let i = 0; i < entries; i += 1) {
    into[entries - 1 - i] += sign * (before + bins[i] / 2);
    before += bins[i];
  }
}

// Moving mean over the width of a soft border.
function softened(light) {
  const at = (i) => light[Math.min(Math.max(i, 0), light.length - 1)];
  const mean = new Float64Array(light.length);
  let whole = 0;
  for (let i = -SOFT; i < SOFT; i += 1) whole += at(i);
  for (let i = 0; i < light.length; i += 1) {
    const next = whole - at(i - SOFT) + at(i + SOFT);
    mean[i] = (whole + next) / (4 * SOFT);
    whole = next;
  }
  return mean;
}
