// The object of a simulated fingertip: what it is, and where. Moved by hand it stays.

const ASK_MS = 60; // delay of requests while a slider is dragged
const HELD_MS = 900; // after a change the status does not write over it

export class Scene {
  constructor(panel) {
    this.panel = panel;
    this.controls = panel.layout.scene;
    this.fields = new Map();
    this.heldUntil = 0;
    this.element = panel.find(".scene");
    this.element.hidden = false;
    this.choice("object", this.controls.objects, "object");
    this.choice("material", this.controls.materials, "material");
    panel.find(".moves").onclick = () => this.ask({ moving: !this.status?.moving });
  }

  /** Fill a list of words, and send the chosen one as `name`. */
  choice(selector, words, name) {
    const select = this.element.querySelector(`.${selector}`);
    select.replaceChildren(...words.map((word) => new Option(word, word)));
    select.onchange = () => {
      select.blur();
      this.ask({ [name]: select.value });
    };
  }

  /** Send a change; of several quick ones each field's last value counts. */
  ask(change) {
    this.change = { ...this.change, ...change };
    this.heldUntil = performance.now() + HELD_MS;
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => {
      const body = this.change;
      this.change = {};
      this.panel.ask("scene", body);
    }, ASK_MS);
  }

  /** Show a status of the server, but not while the user changes it. */
  update(status) {
    if (performance.now() < this.heldUntil) return;
    this.status = status;
    this.element.querySelector(".object").value = status.object;
    this.element.querySelector(".material").value = status.material;
    this.panel.find(".moves").setAttribute("aria-pressed", status.moving);
    if (this.shown !== status.now) this.place(status.now);
    for (const [name, { slider, entry }] of this.fields) {
      const value = Number(status.values[name].toFixed(1));
      slider.value = value;
      if (document.activeElement !== entry) entry.value = value;
    }
  }

  /** Put the fields of an object on the page. */
  place(object) {
    this.shown = object;
    this.fields.clear();
    const row = this.element.querySelector(".fields");
    row.replaceChildren(...Object.entries(this.controls.fields[object]).map(
      ([name, limits]) => this.field(object, name, limits),
    ));
  }

  field(object, name, [least, most]) {
    const label = document.createElement("label");
    const [slider, entry] = [document.createElement("input"), document.createElement("input")];
    const [word, unit] = [name.replace(/_.*/, ""), name.endsWith("deg") ? "°" : "mm"];
    // A twin computes for half a second for each new diameter of a cable.
    const step = name === "diameter_mm" ? 0.5 : 0.1;
    Object.assign(slider, { type: "range", min: least, max: most, step, tabIndex: -1 });
    slider.ariaLabel = `${word}, slider`;
    Object.assign(entry, { type: "text", inputMode: "decimal", name, size: 5 });
    slider.oninput = () => {
      entry.value = slider.value;
      this.ask({ object, [name]: Number(slider.value) });
    };
    entry.onchange = () => this.ask({ object, [name]: numberOf(entry.value) });
    entry.onkeydown = ({ key }) => { if (key === "Enter") entry.blur(); };
    label.append(word, slider, entry, unit);
    this.fields.set(name, { slider, entry });
    return label;
  }
}

/** The number typed; other text as it is, which the server refuses with the limits. */
function numberOf(text) {
  const number = Number(text.trim().replace("−", "-").replace(",", "."));
  return text.trim() && Number.isFinite(number) ? number : text;
}
