// The controls of a replay.

const SEEK_MS = 60; // delay of requests while the slider is dragged

export class Player {
  constructor(panel) {
    this.panel = panel;
    this.status = null;
    this.heldUntil = 0;
    panel.find(".player").hidden = false;
    panel.find(".actions").hidden = true;
    panel.find(".close").hidden = false;
    panel.find(".close").onclick = () => panel.ask("close");
    panel.find(".play").onclick = () => this.toggle();
    panel.find(".speed").onchange = ({ target }) => {
      target.blur();
      this.ask({ speed: Number(target.value) });
    };
    panel.find(".seek").oninput = ({ target }) => this.seek(Number(target.value));
  }

  ask(change) {
    return this.panel.ask("player", change);
  }

  toggle() {
    if (this.status) this.ask({ playing: !this.status.playing });
  }

  /** Move by some seconds. */
  seekBy(seconds) {
    if (this.status) this.seek(this.status.position_s + seconds);
  }

  /** Move to a time; of several quick calls the last one counts. */
  seek(seconds) {
    if (!this.status) return;
    const position_s = Math.min(Math.max(seconds, 0), this.status.length_s);
    this.show({ ...this.status, position_s });
    this.heldUntil = performance.now() + 700;
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this.ask({ position_s }), SEEK_MS);
  }

  /** Show a status of the server, but not while the user moves the slider. */
  update(status) {
    if (status && performance.now() > this.heldUntil) this.show(status);
  }

  show(status) {
    this.status = status;
    const { playing, position_s, length_s, speed } = status;
    const seek = this.panel.find(".seek");
    seek.max = length_s;
    seek.value = position_s;
    this.panel.find(".position").textContent = `${clock(position_s)} / ${clock(length_s)}`;
    this.panel.find(".play").firstChild.textContent = playing ? "Pause " : "Play ";
    this.panel.find(".play").setAttribute("aria-pressed", playing);
    const list = this.panel.find(".speed");
    const options = [...list.options];
    if (!options.some(({ value }) => Number(value) === speed)) { // such as one of the address
      list.add(new Option(`${speed} ×`, speed), options.find(({ value }) => value > speed));
    }
    list.value = String(speed);
  }
}

/** Minutes, seconds and tenths. */
function clock(seconds) {
  const tenths = Math.round(seconds * 10);
  const rest = ((tenths % 600) / 10).toFixed(1).padStart(4, "0");
  return `${Math.floor(tenths / 600)}:${rest}`;
}
