// Keyboard: one table for what keys do and for the help that says so.

const SHOWN = { " ": "Space", 1: "1 … 9", ArrowLeft: "←", ArrowRight: "→" };

export class Keys {
  /** `table` has rows [keys, text, action]; the first key is the one shown. */
  constructor(table, list) {
    this.actions = new Map();
    for (const [keys, text, action] of table) {
      for (const key of keys) this.actions.set(key, action);
      const term = document.createElement("dt");
      const shown = document.createElement("kbd");
      shown.textContent = SHOWN[keys[0]] || keys[0].toUpperCase();
      term.append(shown);
      const told = document.createElement("dd");
      told.textContent = text;
      list.append(term, told);
    }
    document.addEventListener("keydown", (event) => this.pressed(event));
    // A button keeps the keyboard after a click, and the next space would press it again.
    document.addEventListener("click", ({ detail, target }) => {
      if (detail > 0) target.closest("button")?.blur();
    });
  }

  pressed(event) {
    const { key, target } = event;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (document.querySelector("dialog[open]")) return;
    if (target.matches("select")) return;
    if (target.matches("button") && (key === " " || key === "Enter")) return;
    const action = this.actions.get(key.length === 1 ? key.toLowerCase() : key);
    if (!action) return;
    event.preventDefault();
    if (!event.repeat || key.startsWith("Arrow")) action(key);
  }
}
