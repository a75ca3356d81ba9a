// The contact of a frame by the published method: white with a dark edge, visible on every colour.

const EDGE = "rgb(10 16 30 / 90%)";
const FILL = "#ffffff";
const CENTRE = "#e8590c";
const ARM = 14; // CSS pixels: seen beside the number of a cell, which lies above it

export function drawContact(brush, grid, contact) {
  if (!contact.markers.length && !contact.centre) return;
  brush.save();
  brush.lineCap = "round";
  const lines = {
    edge: () => contact.line && border(contact.line.point, contact.line.angle),
    corner: () => contact.corner && rays(contact.corner),
    cable: () => contact.cable && cable(contact.cable),
  }[contact.shape]?.();
  brush.save();
  brush.beginPath();
  brush.rect(...grid.rectangle);
  brush.clip();
  for (const [from, to, dash] of lines || []) segment(brush, grid, from, to, dash);
  brush.restore();
  for (let i = 0; i < contact.markers.length; i += 2) {
    disc(brush, grid.at([contact.markers[i], contact.markers[i + 1]]), 3.5, FILL);
  }
  if (contact.centre) cross(brush, grid.at(contact.centre));
  brush.restore();

  function border(point, angle, dash = []) {
    return [[ahead(point, angle, -grid.reach), ahead(point, angle, grid.reach), dash]];
  }

  function rays({ vertex, directions }) {
    return directions.map((angle) => [vertex, ahead(vertex, angle, grid.reach), []]);
  }

  function cable({ point, angle, width }) {
    return [
      ...border(ahead(point, angle + 90, width / 2), angle),
      ...border(ahead(point, angle - 90, width / 2), angle),
      ...border(point, angle, [7, 7]),
    ];
  }
}

/** The point at a distance in a direction (mm, degrees counter-clockwise from +x). */
function ahead([x, y], degrees, far) {
  const angle = (degrees * Math.PI) / 180;
  return [x + far * Math.cos(angle), y + far * Math.sin(angle)];
}

function segment(brush, grid, from, to, dash) {
  brush.setLineDash(dash);
  for (const [colour, width] of [[EDGE, 4.5], [FILL, 2]]) {
    brush.strokeStyle = colour;
    brush.lineWidth = width;
    brush.beginPath();
    brush.moveTo(...grid.at(from));
    brush.lineTo(...grid.at(to));
    brush.stroke();
  }
  brush.setLineDash([]);
}

function disc(brush, [x, y], radius, colour) {
  brush.beginPath();
  brush.arc(x, y, radius, 0, 2 * Math.PI);
  brush.fillStyle = colour;
  brush.fill();
  brush.strokeStyle = EDGE;
  brush.lineWidth = 1.5;
  brush.stroke();
}

/** The dark centre. */
function cross(brush, [x, y]) {
  for (const [colour, width] of [[FILL, 6], [CENTRE, 3]]) {
    brush.strokeStyle = colour;
    brush.lineWidth = width;
    brush.beginPath();
    brush.moveTo(x - ARM, y);
    brush.lineTo(x + ARM, y);
    brush.moveTo(x, y - ARM);
    brush.lineTo(x, y + ARM);
    brush.stroke();
  }
}
