// Fills the page with what the server sends: sections as they are computed, sliders for the numbers of the scene.
(() => {
  "use strict";

  const at = (id) => document.getElementById(id);
  const make = (parent, name, attributes, text) => {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes || {})) element.setAttribute(key, value);
    if (text !== undefined) element.textContent = text;
    parent.append(element);
    return element;
  };

  // Sections -------------------------------------------------------------------------------------------------------------

  // Replaces what a section shows. The reader stays where he was, and so does a player that he has moved.
  const fill = (section, { html, text }) => {
    const old = section.querySelector("figure.player");
    const kept = old && old.player && old.dataset.moved ? { run: Number(old.dataset.run), frame: Number(old.dataset.frame) } : null;
    const focus = section.contains(document.activeElement);
    const control = focus && [...section.querySelectorAll("button, input, select")].indexOf(document.activeElement);
    section.classList.remove("old");
    if (old && old.player) old.player.end();
    const place = window.scrollY;
    if (html !== undefined) section.innerHTML = html;
    else { section.replaceChildren(); make(section, "pre", { class: "text", tabindex: 0 }, text); }
    window.startPlayers();
    const figure = section.querySelector("figure.player");
    if (figure) {
      for (const kind of ["pointerdown", "keydown"]) figure.addEventListener(kind, () => { figure.dataset.moved = "yes"; });
      if (kept) {
        if (kept.run < JSON.parse(figure.querySelector("script").textContent).length) figure.player.choose(kept.run);
        figure.player.show(kept.frame);
        figure.dataset.moved = "yes";
      }
    }
    // What scrolls sideways is reached by keys.
    section.querySelectorAll(".scroll, pre").forEach((wide) => { wide.tabIndex = 0; });
    const controls = section.querySelectorAll("button, input, select");
    if (focus && controls[control]) controls[control].focus({ preventScroll: true });
    window.scrollTo(0, place);
  };

  // Sliders --------------------------------------------------------------------------------------------------------------

  const wanted = { n: 0, set: {} };
  const chosen = new Set(["friction.coefficient"]);
  let knobs = [];
  let sending = null;
  let again = false;

  const post = (path, body) => fetch(path, { method: "POST", body: JSON.stringify(body) });
  // One request at a time; what was moved meanwhile is sent after it.
  const send = async () => {
    if (sending) { again = true; return; }
    do {
      again = false;
      sending = post("set", wanted);
      try {
        const answer = await sending;
        if (!answer.ok) at("note").textContent = await answer.text();
      } catch (error) {
        at("note").textContent = "the program does not answer";
      }
    } while (again);
    sending = null;
  };

  const shown = (value) => String(Number(value.toPrecision(6)));
  // Twice the value as written to either side at most, and what the scene allows.
  const range = ({ value, bounds: [least, most] }) => {
    const size = Math.abs(value) || 1;
    const low = value < 0 || value === 0 ? -2 * size : 0;
    const high = value < 0 ? 0 : 2 * size;
    return [Math.max(low, least ?? -Infinity), Math.min(high, most ?? Infinity)];
  };

  const slider = (name, label, unit, [low, high], step, value, change, writeBack) => {
    const row = make(at("rows"), "div", { class: "row", "data-name": name });
    const id = `slider ${name}`.replace(/[^\w]/g, "-");
    make(row, "label", { for: id }, label);
    const input = make(row, "input", { type: "range", id, min: low, max: high, step });
    const output = make(row, "output", { for: id });
    input.value = value;
    const tell = (now) => { output.textContent = `${shown(now)}${unit ? ` ${unit}` : ""}`; input.setAttribute("aria-valuetext", output.textContent); };
    tell(value);
    input.addEventListener("input", () => { const now = Number(Number(input.value).toPrecision(4)); tell(now); change(now); send(); });
    if (writeBack) writeBack(make(row, "button", { type: "button", id: `write-${id}`, "aria-label": `write back ${label}` }, "write back"), input);
  };

  const draw = () => {
    const focused = document.activeElement && document.activeElement.id;
    const open = at("rows").querySelector("details")?.open;
    at("rows").replaceChildren();
    slider("n", "n, tolerance level", "σ", [-5, 5], 0.1, wanted.n, (value) => { wanted.n = value; });
    const rows = at("rows");
    for (const knob of knobs.filter(({ name }) => chosen.has(name))) {
      const [low, high] = range(knob);
      const value = wanted.set[knob.name] ?? knob.value;
      slider(knob.name, knob.name.replace("#", ", number "), knob.unit, [Math.min(low, value), Math.max(high, value)], "any", value,
        (now) => { wanted.set[knob.name] = now; },
        (button, input) => {
          button.disabled = !(knob.name in wanted.set);
          input.addEventListener("input", () => { button.disabled = false; });
          // Arrow keys step by a fiftieth of the range.
          input.addEventListener("keydown", (event) => {
            const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
            if (!step) return;
            event.preventDefault();
            input.value = Number(input.value) + step * (high - low) / 50;
            input.dispatchEvent(new Event("input"));
          });
          button.addEventListener("click", async () => {
            const answer = await post("write", { name: knob.name, value: wanted.set[knob.name] });
            at("note").textContent = answer.ok ? `${knob.name} is written` : await answer.text();
            if (answer.ok) { delete wanted.set[knob.name]; button.disabled = true; }
          });
        });
    }
    const choice = at("choice");
    choice.replaceChildren();
    make(choice, "option", { value: "" }, "choose a key");
    for (const { name } of knobs.filter(({ name }) => !chosen.has(name))) make(choice, "option", { value: name }, name.replace("#", ", number "));
    if (focused && at(focused)) at(focused).focus({ preventScroll: true });
  };

  at("add").addEventListener("click", () => { if (at("choice").value) { chosen.add(at("choice").value); draw(); } });

  // Events ---------------------------------------------------------------------------------------------------------------

  const events = new EventSource("events");
  const on = (name, take) => events.addEventListener(name, (event) => take(JSON.parse(event.data)));
  const bodies = () => [at("unit"), ...document.querySelectorAll("details > div")];
  on("status", (text) => {
    at("status").textContent = text;
    if (text.startsWith("computes")) bodies().forEach((body) => body.classList.add("old"));
  });
  on("problem", (text) => {
    at("error").hidden = !text;
    if (at("error").textContent !== text) at("error").textContent = text;
    if (text) bodies().forEach((body) => body.classList.add("old"));
  });
  on("unit", (section) => fill(at("unit"), section));
  for (const name of ["check", "tolerance", "population"]) {
    on(name, (section) => { at(name).hidden = section.text === ""; fill(at(name).lastElementChild, section); });
  }
  on("knobs", (now) => {
    const same = JSON.stringify(knobs) === JSON.stringify(now.knobs);
    const first = !knobs.length;
    knobs = now.knobs;
    if (first) {
      // A page that was opened anew shows what is asked for.
      Object.assign(wanted, now.wanted);
      Object.keys(wanted.set).forEach((name) => chosen.add(name));
      // Each gap, where they are few.
      const gaps = knobs.filter((knob) => knob.is_gap);
      if (gaps.length <= 6) gaps.forEach(({ name }) => chosen.add(name));
    }
    if (!same) draw();
  });
  events.addEventListener("error", () => { at("status").textContent = "the program does not answer"; });
})();
