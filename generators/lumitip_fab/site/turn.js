// Pointers and keys that turn a 3D view.
const KEYS = {
  ArrowLeft: (m) => m.turn(0.12, 0), ArrowRight: (m) => m.turn(-0.12, 0),
  ArrowUp: (m) => m.turn(0, 0.12), ArrowDown: (m) => m.turn(0, -0.12),
  "+": (m) => m.zoom(0.87), "-": (m) => m.zoom(1.15), 0: (m) => m.home(),
};

// A view that pointers and keys turn; a click that is no drag is passed on.
function turnable(model, label, clicked = () => {}) {
  const { canvas } = model;
  const held = new Map();
  let travelled = 0;
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "application");
  canvas.setAttribute("aria-label", label);
  canvas.addEventListener("keydown", (event) => {
    if (!KEYS[event.key] || event.ctrlKey || event.metaKey) return;
    KEYS[event.key](model);
    event.preventDefault();
  });
  canvas.addEventListener("wheel", (event) => {
    if (document.activeElement !== canvas) return; // the page scrolls until the view is chosen
    model.zoom(Math.exp(Math.sign(event.deltaY) * 0.09));
    event.preventDefault();
  }, { passive: false });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, event);
    if (held.size === 1) travelled = 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = held.get(event.pointerId);
    if (!before) return;
    const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY];
    travelled += Math.hypot(dx, dy);
    const other = [...held.values()].find((e) => e.pointerId !== event.pointerId);
    held.set(event.pointerId, event);
    if (other) {
      const apart = (e) => Math.hypot(e.clientX - other.clientX, e.clientY - other.clientY) || 1;
      model.zoom(apart(before) / apart(event));
      model.pan(dx / 2, dy / 2);
    } else if (event.buttons === 2 || event.shiftKey) model.pan(dx, dy);
    else model.turn(dx * 0.008, dy * 0.008);
  });
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, (event) => {
      held.delete(event.pointerId);
      if (name !== "pointerup" || travelled > 5 || event.button) return;
      clicked(event);
    });
  }
}
