// A player for the motion of a mechanism with play in its joints.
//
// It turns every figure of the class "player" that holds a script element of the type "application/json" with DATA into a
// picture that moves: travel at true scale, the motion within the play enlarged, each pin in its gap, the contact forces.
//
// DATA is one run, or a list of runs of the same mechanism from which the reader chooses. Lengths are in mm, angles in rad,
// forces in N, times in ms. A *series* is a list with one number per frame, or one number that never changes. A *point* is
// [x, y, z]; angles are about the axes x, y, z of the frame, right-handed. A run is an object of
//   title   text
//   label   text for the choice among runs (required if there are several)
//   t       rising list of times, at least two; need not be evenly spaced
//   views   one or two of { name, axes: [right, up] }; an axis is "x", "y", "z" or one of them with a minus, such as "-z"
//   bodies  list of { name, at, outline, travel, sway }
//             at       point: the centre of mass in the drawn pose, about which the body turns
//             outline  list of closed polygons, each a list of points, in the drawn pose
//             travel   { x, y, z, ax, ay, az }, each a series, or absent where it is 0: drawn at true scale. Displacement of
//                      the centre of mass and rotation vector
//             sway     the same keys, added to travel and enlarged; its angles must be small
//   joints  list of { name, at, between, axes, box, pin, contacts }
//             at       point: the pin in the drawn pose
//             between  [body that carries the pin, body that carries the gap], each a body's name or "frame"
//             axes     the two axes of the plane in which the gap lies, such as ["x", "y"]
//             box      [left, right, low, high]: limits of the pin's place in the gap, along the first axis and the second;
//                      null: open. A limit beyond 0 is a preload
//             round    true where the gap is the circle in this box; its one contact has the side "around"
//             turn     angle from the axes in the drawn pose to those of box and pin; absent: 0
//             pin      two series: the pin's place in the gap along the axes, 0 in the drawn pose
//             contacts list of { side, name, force }: side "left", "right", "low" or "high", name what the side is called, force
//                      a series
//   plots   list of { name, unit, values }: curves over time
//   events  list of { t, name }: moments to mark; may be absent
//   from    from when on the greatest value of the first curve is its peak, at which the player opens; absent: from the start
// The element of the figure has the property `player` with show(frame), choose(run), play(), pause(), end() for a figure that
// leaves the page, and the attributes data-frame and data-run, which follow what is seen. startPlayers() starts figures that were added.
(() => {
  "use strict";

  const LEVELS = 6;             // colours of forces
  const BODY_COLOURS = [0, 2, 7, 6, 3];
  // Lines in a square of 8 px that is repeated: they tell bodies apart without colour.
  const [RISING, FALLING] = ["M-1 9L9 -1M-1 1L1 -1M7 9L9 7", "M-1 -1L9 9M-1 7L1 9M7 -1L9 1"];
  const HATCHES = [[], [RISING], [FALLING], [RISING, FALLING]];
  const SIDES = ["left", "right", "low", "high"];

  // Elements -------------------------------------------------------------------------------------------------------------

  const put = (parent, element, attributes, text) => {
    for (const [key, value] of Object.entries(attributes || {})) element.setAttribute(key, value);
    if (text !== undefined) element.textContent = text;
    if (parent) parent.append(element);
    return element;
  };
  const html = (parent, name, attributes, text) => put(parent, document.createElement(name), attributes, text);
  const svg = (parent, name, attributes, text) =>
    put(parent, document.createElementNS("http://www.w3.org/2000/svg", name), attributes, text);
  const set = (element, attributes) => put(null, element, attributes);

  // Numbers --------------------------------------------------------------------------------------------------------------

  const px = (value) => String(Math.round(value * 100) / 100);
  const shown = (value, digits = 3) => String(Number(value.toPrecision(digits))).replace("-", "−");
  const milliseconds = (t) => `${t.toFixed(1)} ms`;
  const extreme = (numbers, of) => numbers.reduce((best, value) => of(best, value), of === Math.max ? -Infinity : Infinity);
  // The greatest of 1, 2, 5 times a power of ten that is not above a value (times what rounding leaves).
  const round125 = (value, steps = [5, 2, 1]) => {
    const power = 10 ** Math.floor(Math.log10(value * (1 + 1e-9)));
    return Number((steps.find((step) => step * power <= value * (1 + 1e-9)) * power).toPrecision(3));
  };
  // A series at a frame, between two frames in proportion.
  const at = (series, frame) => {
    if (series === undefined || typeof series === "number") return series || 0;
    const before = Math.min(Math.floor(frame), series.length - 1);
    const after = Math.min(before + 1, series.length - 1);
    return series[before] + (frame - before) * (series[after] - series[before]);
  };
  const frameAt = (t, time) => {
    let after = t.findIndex((value) => value >= time);
    if (after < 0) after = t.length - 1;
    return after === 0 ? 0 : after - 1 + (time - t[after - 1]) / (t[after] - t[after - 1]);
  };
  const every = (series) => (typeof series === "number" ? [series] : series);

  // Motion ---------------------------------------------------------------------------------------------------------------

  const add = (a, b, factor = 1) => a.map((value, i) => value + factor * b[i]);
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  // v turned by a rotation vector.
  const turned = (v, rotation) => {
    const angle = Math.hypot(...rotation);
    if (angle === 0) return v;
    const axis = rotation.map((value) => value / angle);
    const along = axis.reduce((sum, value, i) => sum + value * v[i], 0) * (1 - Math.cos(angle));
    return add(add(v.map((value) => value * Math.cos(angle)), cross(axis, v), Math.sin(angle)), axis, along);
  };
  const motion = (series, frame) => {
    const of = (...keys) => keys.map((key) => at((series || {})[key], frame));
    return { shift: of("x", "y", "z"), turn: of("ax", "ay", "az") };
  };
  // Where the points of a body are at a frame, what play does to them times `play`. Enlarged turns stay linear, so that an
  // enlarged gap closes at the very moment at which the true one does.
  const pose = (body, frame, play) => {
    if (!body) return { place: (point) => point, turn: [0, 0, 0] };
    const [travel, sway] = [motion(body.travel, frame), motion(body.sway, frame)];
    const centre = body.at;
    const place = (point) => {
      const arm = turned(add(point, centre, -1), travel.turn);
      return add(add(add(centre, travel.shift), arm), add(sway.shift, cross(sway.turn, arm)), play);
    };
    return { place, turn: add(travel.turn, sway.turn, play) };
  };

  const parseAxis = (name) => ({ letter: name.slice(-1), index: "xyz".indexOf(name.slice(-1)), sign: name[0] === "-" ? -1 : 1 });
  const project = (axes, point) => axes.map(({ index, sign }) => sign * point[index]);
  // The turn seen in a view, counter-clockwise: about the axis towards the reader.
  const seenTurn = (axes, turn) => {
    const unit = ({ index, sign }) => [0, 1, 2].map((i) => (i === index ? sign : 0));
    return cross(unit(axes[0]), unit(axes[1])).reduce((sum, value, i) => sum + value * turn[i], 0);
  };
  const sways = ({ sway }) => Object.keys(sway || {}).length > 0;
  const bodyOf = (run, name) => run.bodies.find((body) => body.name === name);

  // What all runs of a player have in common: enlargement, pictures' limits, colours --------------------------------------

  // The first thing wrong with a run, or nothing.
  const fault = (run) => {
    const frames = Array.isArray(run.t) ? run.t.length : 0;
    if (frames < 2 || run.t.some((t, i) => i && !(t > run.t[i - 1]))) return "t must rise and have two frames or more";
    const wrong = (series) => series !== undefined && !Number.isFinite(series)
      && !(Array.isArray(series) && series.length === frames && series.every(Number.isFinite));
    const known = (name) => name === "frame" || bodyOf(run, name);
    for (const { name, travel, sway } of run.bodies)
      for (const series of [travel || {}, sway || {}])
        for (const key in series) if (wrong(series[key])) return `${name}: ${key} needs ${frames} numbers`;
    for (const { name, between, pin, contacts } of run.joints) {
      if (!between.every(known)) return `${name}: unknown body`;
      if (pin.length !== 2 || pin.some(wrong)) return `${name}: pin needs two lists of ${frames} numbers`;
      for (const { side, force } of contacts)
        if (wrong(force) || !(SIDES.includes(side) || side === "around")) return `${name}: contact ${side || ""}`;
    }
    for (const { name, values } of run.plots) if (wrong(values)) return `${name}: needs ${frames} numbers`;
    return undefined;
  };

  const clearances = ({ box }) =>
    [[0, 1], [2, 3]].filter(([i, j]) => box[i] !== null && box[j] !== null).map(([i, j]) => Math.abs(box[j] - box[i]));

  const survey = (runs) => {
    const bounds = (play) => runs[0].views.map(({ axes }) => {
      const parsed = axes.map(parseAxis);
      const limits = [[Infinity, -Infinity], [Infinity, -Infinity]];
      const widen = (point, margin = 0) => project(parsed, point).forEach((value, i) => {
        limits[i] = [Math.min(limits[i][0], value - margin), Math.max(limits[i][1], value + margin)];
      });
      for (const run of runs) {
        for (let frame = 0; frame < run.t.length; frame++) {
          for (const body of run.bodies) {
            const { place } = pose(body, frame, play);
            body.outline.flat().forEach((point) => widen(place(point)));
          }
          for (const joint of run.joints) {
            const gap = extreme(clearances(joint).filter((size) => size < 5).concat(0), Math.max);
            widen(pose(bodyOf(run, joint.between[0]), frame, play).place(joint.at), play * gap);
          }
        }
      }
      return limits;
    });
    const size = Math.max(...bounds(0)[0].map(([low, high]) => high - low));
    let [shift, turn] = [0, 0];
    for (const run of runs) for (const body of run.bodies) for (let frame = 0; frame < run.t.length; frame++) {
      const [sway, still] = [motion(body.sway, frame), pose(body, frame, 0).place];
      const lively = pose(body, frame, 1).place;
      body.outline.flat().forEach((p) => { shift = Math.max(shift, Math.hypot(...add(lively(p), still(p), -1))); });
      turn = Math.max(turn, Math.hypot(...sway.turn));
    }
    const gaps = runs.flatMap((run) => run.joints.flatMap(clearances)).filter((gap) => gap > 0).sort((a, b) => a - b);
    const gap = gaps.length ? gaps[Math.floor(gaps.length / 2)] : 1;
    const play = Math.max(1, round125(Math.min(0.1 * size / gap, 0.15 * size / shift, 0.3 / turn), [5, 3, 2, 1]));
    const forces = runs.flatMap((run) => run.joints.flatMap(({ contacts }) => contacts.flatMap(({ force }) => every(force))));
    const greatest = extreme(forces.concat(1e-6), Math.max);
    const thresholds = [round125(greatest)];
    while (thresholds.length < LEVELS) thresholds.unshift(round125(0.6 * thresholds[0]));
    // 0: no contact; 1 to LEVELS: a colour.
    const level = (force) => (force < thresholds[0] / 10 ? 0
      : Math.max(1, thresholds.filter((threshold) => force >= threshold).length));
    const ranges = runs[0].plots.map((_, i) => {
      const values = runs.flatMap((run) => every(run.plots[i].values));
      const [low, high] = [Math.min(0, extreme(values, Math.min)), Math.max(0, extreme(values, Math.max))];
      return low === high ? [0, 1] : [low, high];
    });
    return { play, thresholds, greatest, level, ranges, bounds: bounds(play) };
  };

  // The looks of body `i`: its class, and what it is filled with, drawn into `picture`. Patterns of a page need names of their own.
  const looks = (picture, i, common) => {
    const kind = `kind-${BODY_COLOURS[i % BODY_COLOURS.length]}`;
    const own = HATCHES[i % HATCHES.length];
    if (!own.length) return { class: `body ${kind}` };
    const id = `player-${common.number}-hatch-${common.hatched++}`;
    const pattern = svg(picture, "pattern", { id, width: 8, height: 8, patternUnits: "userSpaceOnUse" });
    svg(pattern, "rect", { class: `ground ${kind}`, width: 8, height: 8 });
    for (const lines of own) svg(pattern, "path", { class: `hatch ${kind}`, d: lines });
    return { class: `body ${kind}`, style: `fill: url(#${id}); fill-opacity: 1` };
  };

  // A pin in its gap ------------------------------------------------------------------------------------------------------

  // The pin's place as it is drawn: a contact gives way under its force, but here its surfaces stay where they are.
  const rigid = (joint, frame) => {
    const pin = joint.pin.map((series) => at(series, frame));
    if (joint.round) {
      const [distance, radius] = [Math.hypot(...pin), joint.box[1]];
      return distance > radius ? pin.map((value) => value * radius / distance) : pin;
    }
    return pin.map((value, axis) => {
      const [low, high] = limitsOf(joint, axis);
      return Math.min(high === null ? Infinity : high, Math.max(low === null ? -Infinity : low, value));
    });
  };
  // A gap that preload has closed altogether has no width.
  const limitsOf = ({ box }, axis) => {
    const [low, high] = box.slice(2 * axis, 2 * axis + 2);
    return low !== null && high !== null && low > high ? [(low + high) / 2, (low + high) / 2] : [low, high];
  };
  // The pin's place on the page, in mm to the right and up.
  const placeOnPage = (joint, axes, frame) => {
    const pin = rigid(joint, frame);
    return axes.map(({ letter, sign }) => { const axis = joint.axes.indexOf(letter); return axis < 0 ? 0 : sign * pin[axis]; });
  };

  // Draws a joint's gap about its pin, in a plane given by the axes to the right and up. The gap is widened by the radius of
  // the pin's dot, so that the dot's rim touches where the pin does. `scale` is in px/mm, `reach` how far open sides go.
  const gapPicture = (parent, joint, axes, { scale, radius, reach, level, words }) => {
    const group = svg(parent, "g", {});
    const gap = svg(group, "g", {});
    const along = axes.map(({ letter, sign }) => {
      const axis = joint.axes.indexOf(letter);
      const limits = axis >= 0 ? limitsOf(joint, axis) : [null, null];
      const sides = axis < 0 ? [] : SIDES.slice(2 * axis, 2 * axis + 2);
      return sign > 0 ? { limits, sides }
        : { limits: limits.map((limit) => (limit === null ? null : -limit)).reverse(), sides: sides.reverse() };
    });
    const parts = [];
    const label = (x, y, anchor) => (words ? svg(gap, "text", { class: "force", x: px(x), y: px(y), "text-anchor": anchor }) : null);
    // Ends of a line along one axis, in px from the pin's place in the drawn pose; open ends reach out.
    const ends = ({ limits: [low, high] }) => [
      low === null ? -reach : low * scale - radius, high === null ? reach : high * scale + radius,
    ];
    const [across, up] = along.map(ends);
    // A hole that is seen along its pin.
    const hole = joint.round && along.every(({ limits }) => limits[0] !== null);
    if (hole) {
      const r = px(joint.box[1] * scale + radius);
      svg(gap, "circle", { class: "room", r });
      const line = svg(gap, "circle", { class: "side hole", r });
      parts.push({ contact: joint.contacts[0], line, text: label(0, -joint.box[1] * scale - radius - 8, "middle") });
    } else if (along.some(({ limits }) => !limits.includes(null))) svg(gap, "rect", { class: "room", x: px(Math.min(...across)), y: px(-Math.max(...up)),
      width: px(Math.abs(across[1] - across[0])), height: px(Math.abs(up[1] - up[0])) });
    if (!hole) along.forEach(({ limits, sides }, axis) => limits.forEach((limit, i) => {
      if (limit === null) return;
      const contact = joint.contacts.find(({ side }) => side === sides[i]);
      const [x1, x2, y1, y2] = axis === 0 ? [across[i], across[i], ...up] : [...across, up[i], up[i]];
      const line = svg(gap, "line", { class: "side", x1: px(x1), x2: px(x2), y1: px(-y1), y2: px(-y2) });
      const outwards = i ? 1 : -1;
      const text = axis === 0 ? label(x1 + 9 * outwards, -(y1 + y2) / 2 + 4, i ? "start" : "end")
        : i ? label((x1 + x2) / 2, -y1 - 8, "middle") : label((x1 + x2) / 2 - 12, -y1 + 18, "start");
      parts.push({ contact, line, text });
    }));
    const pin = svg(group, "circle", { class: "pin", r: px(radius) });
    const update = (frame, [x, y], turn = 0, still = false) => {
      const [right, up] = placeOnPage(joint, axes, frame).map((value) => value * scale);
      set(group, { transform: `translate(${px(x)} ${px(y)}) rotate(${px(-turn * 180 / Math.PI)})` });
      // Either the gap stands still, or the pin.
      set(gap, { transform: still ? "" : `translate(${px(-right)} ${px(up)})` });
      set(pin, still ? { cx: px(right), cy: px(-up) } : {});
      for (const { contact, line, text } of parts) {
        const force = contact ? at(contact.force, frame) : 0;
        const colour = level(force);
        set(line, { class: (colour ? `side touches force-${colour}` : "side") + (hole ? " hole" : "") });
        if (text) text.textContent = colour ? `${shown(force, 2)} N` : "";
      }
    };
    return update;
  };

  // The pictures ----------------------------------------------------------------------------------------------------------

  // A view of the mechanism; gives what draws it at a frame.
  const viewPicture = (parent, run, which, common) => {
    const { name, axes: names } = run.views[which];
    const axes = names.map(parseAxis);
    const [[left, right], [low, high]] = common.bounds[which];
    const [wide, tall] = [right - left, high - low];
    const width = wide < tall ? 300 : 560;
    // The axes stand below what is drawn.
    const [margin, below] = [14, 48];
    const scale = Math.min((width - 2 * margin) / wide, (520 - margin - below) / tall);
    const height = tall * scale + margin + below;
    const across = (width - wide * scale) / 2;
    const place = (point) => { const [u, v] = project(axes, point); return [(u - left) * scale + across, (high - v) * scale + margin]; };
    if (wide < tall) parent.classList.add("tall");
    const box = html(parent, "div", { class: "view" });
    const head = html(box, "p", { class: "head" });
    html(head, "b", {}, name);
    html(head, "span", {}, `travel × 1, gaps × ${shown(common.play)}`);
    const picture = svg(box, "svg", { viewBox: `0 0 ${px(width)} ${px(height)}`, role: "img", "aria-label": `${run.title}, ${name}` });
    const outline = (polygon, move) => `M${polygon.map((point) => place(move(point)).map(px).join(" ")).join("L")}Z`;
    const depth = (point) => seenTurn(axes, point);
    const mean = (points) => points.reduce((sum, point) => sum + depth(point), 0) / points.length;
    const bodies = run.bodies.map((body, i) => {
      const own = looks(picture, i, common);
      const ghost = sways(body) ? svg(picture, "path", { class: "ghost" }) : null;
      // Faces that are farther from the reader are drawn first, and fainter.
      const depths = body.outline.map(mean);
      const [far, near] = [extreme(depths, Math.min), extreme(depths, Math.max)];
      const faces = body.outline.map((polygon, i) => ({ polygon, nearness: near > far ? (depths[i] - far) / (near - far) : 1 }))
        .sort((a, b) => a.nearness - b.nearness)
        .map(({ polygon, nearness }) => ({ polygon, path: svg(picture, "path", { ...own, opacity: px(0.4 + 0.6 * nearness) }) }));
      return { body, ghost, faces };
    });
    const nearest = extreme(run.joints.map((joint) => depth(joint.at)), Math.max);
    // What travels to a stop has a gap too large to be enlarged here.
    const small = ({ box: limits }) => limits.every((limit) => Math.abs(limit) * common.play < 0.3 * Math.max(wide, tall));
    const whole = ({ round, axes: own }) => !round || axes.every(({ letter }) => own.includes(letter));
    const gaps = run.joints.filter((joint) => small(joint) && whole(joint)).sort((a, b) => depth(a.at) - depth(b.at)).map((joint) => {
      const group = svg(picture, "g", depth(joint.at) < nearest - 1e-6 ? { class: "far" } : {});
      return { joint, update: gapPicture(group, joint, axes, { scale: scale * common.play, radius: 3.5, reach: 22, level: common.level }) };
    });
    const centres = bodies.map(({ body }) => {
      const group = svg(picture, "g", { class: "centre" });
      svg(group, "title", {}, `centre of mass of ${body.name}`);
      svg(group, "circle", { r: 6 });
      svg(group, "path", { d: "M0 0V-6A6 6 0 0 1 6 0ZM0 0V6A6 6 0 0 1 -6 0Z" });
      return { body, group };
    });
    // The axes, in the lower left corner.
    const corner = svg(picture, "g", { class: "axes", transform: `translate(${axes[0].sign > 0 ? 12 : 34} ${px(height - (axes[1].sign > 0 ? 12 : 34))})` });
    axes.forEach(({ letter, sign }, i) => {
      const [x, y] = i ? [0, -sign] : [sign, 0];
      svg(corner, "path", { d: `M0 0L${22 * x} ${22 * y}m${-5 * x - 3 * y} ${-5 * y - 3 * x}L${22 * x} ${22 * y}l${-5 * x + 3 * y} ${-5 * y + 3 * x}` });
      svg(corner, "text", { x: x ? 30 * x : 10, y: y ? 22 * y + (y < 0 ? 4 : 6) : 4, "text-anchor": "middle" }, letter);
    });
    return (frame) => {
      for (const { body, ghost, faces } of bodies) {
        const [still, lively] = [0, common.play].map((play) => pose(body, frame, play).place);
        if (ghost) set(ghost, { d: body.outline.map((polygon) => outline(polygon, still)).join("") });
        for (const { polygon, path } of faces) set(path, { d: outline(polygon, lively) });
      }
      for (const { joint, update } of gaps) {
        const [pinBody, gapBody] = joint.between.map((body) => pose(bodyOf(run, body), frame, common.play));
        // Walls turn with their body.
        update(frame, place(pinBody.place(joint.at)), seenTurn(axes, gapBody.turn) + (joint.turn || 0));
      }
      for (const { body, group } of centres) {
        set(group, { transform: `translate(${place(pose(body, frame, common.play).place(body.at)).map(px).join(" ")})` });
      }
    };
  };

  // Every joint's gap at large, all at one scale if that is legible.
  const insetPictures = (parent, run, common) => {
    // Numbers stand on either side of a gap, the scale below.
    const [width, height, below, room, radius] = [240, 146, 20, 76, 8];
    const spans = run.joints.map((joint) => [0, 1].map((axis) => {
      const limits = limitsOf(joint, axis).filter((limit) => limit !== null);
      const open = limits.length < 2 ? every(joint.pin[axis]) : [];
      return [extreme([...limits, ...open], Math.min), extreme([...limits, ...open], Math.max)];
    }));
    const views = run.joints.map((joint) => run.views.find((view) => view.axes.map(parseAxis).every(({ letter }) => joint.axes.includes(letter))));
    const axesOf = run.joints.map((joint, i) => (views[i] ? views[i].axes : joint.axes).map(parseAxis));
    const fits = run.joints.map((joint, i) => Math.min(...axesOf[i].map(({ letter }) => {
      const [low, high] = spans[i][joint.axes.indexOf(letter)];
      return room / Math.max(high - low, 1e-6);
    })));
    const planes = run.joints.map((joint, i) => (views[i] ? views[i].name : joint.axes.join("–")));
    const single = planes.every((plane) => plane === planes[0]);
    const top = html(parent, "p", { class: "head" });
    html(top, "b", {}, run.joints.length > 1 ? "pins in their gaps" : "the pin in its gap");
    if (single) html(top, "span", {}, planes[0]);
    const box = html(parent, "div", { class: run.joints.length > 1 ? "insets" : "insets one" });
    const pictures = run.joints.map((joint, i) => {
      const scale = extreme(fits.filter((fit) => fit <= fits[i] && fit > fits[i] / 5), Math.min);
      const axes = axesOf[i];
      const cell = html(box, "div", { class: "inset" });
      const head = html(cell, "p", { class: "head" });
      html(head, "b", {}, joint.name);
      if (!single) html(head, "span", {}, planes[i]);
      const picture = svg(cell, "svg", { viewBox: `0 0 ${width} ${height + below}`, role: "img", "aria-label": `gap of ${joint.name}` });
      const trail = svg(picture, "polyline", { class: "trail" });
      const update = gapPicture(picture, joint, axes, { scale, radius, reach: 60, level: common.level, words: true });
      // The middle of the gap stands in the middle of the picture.
      const middle = axes.map(({ letter, sign }) => sign * spans[i][joint.axes.indexOf(letter)].reduce((a, b) => a + b) / 2);
      const origin = [width / 2 - middle[0] * scale, height / 2 + middle[1] * scale];
      const path = run.t.map((_, frame) => placeOnPage(joint, axes, frame));
      set(trail, { points: path.map(([right, up]) => `${px(origin[0] + scale * right)},${px(origin[1] - scale * up)}`).join(" ") });
      const bar = round125(48 / scale);
      svg(picture, "path", { class: "bar", d: `M4 ${height + 9}v4h${px(bar * scale)}v-4` });
      svg(picture, "text", { class: "note", x: px(10 + bar * scale), y: height + 16 }, `${shown(bar)} mm`);
      return (frame) => update(frame, origin, 0, true);
    });
    return (frame) => pictures.forEach((draw) => draw(frame));
  };

  const legend = (parent, common) => {
    const box = html(parent, "div", { class: "legend" });
    html(box, "span", {}, "contact force, N");
    const scale = html(box, "span", { class: "scale" });
    html(scale, "i", { class: "none", "data-from": "none" });
    common.thresholds.forEach((threshold, i) => html(scale, "i", { class: `force-${i + 1}`, "data-from": i ? shown(threshold) : "> 0" }));
    html(box, "span", {}, `greatest ${shown(common.greatest)} N`);
  };

  // Curves, contacts and events over one common axis of time, with the slider on top.
  const timeline = (parent, run, common, seek) => {
    const [first, last] = [run.t[0], run.t[run.t.length - 1]];
    const share = (t) => (t - first) / (last - first);
    const percent = (t) => `${px(100 * share(t))}%`;
    const box = html(parent, "div", { class: "timeline" });
    let rows = 0;
    const row = (kind) => {
      const style = `grid-row: ${++rows}`;
      return [html(box, "div", { class: `name ${kind}`, style }), html(box, "div", { class: `chart ${kind}`, style })];
    };

    const [left, rail] = row("controls");
    const button = html(left, "button", { type: "button" });
    const slider = html(rail, "input", { type: "range", min: first, max: last, step: "any", "aria-label": "time" });

    if ((run.events || []).length) {
      const [, chart] = row("events");
      chart.style.height = `${1.35 * run.events.length}em`;
      run.events.forEach(({ t, name: text }, i) => {
        // A line of its own each, so that no name meets another however narrow the page; on the side with more room.
        const side = share(t) > 0.5 ? "before" : "after";
        const style = `left:${percent(t)}; top:${1.35 * i}em`;
        html(chart, "span", { style, class: side, title: milliseconds(t) }, text);
      });
    }
    const plots = run.plots.map(({ name, unit, values }, i) => {
      const [low, high] = common.ranges[i];
      const [head, chart] = row("plot");
      html(head, "b", {}, name);
      const number = html(head, "span", {});
      html(head, "small", { class: "high" }, shown(high));
      html(head, "small", { class: "low" }, Math.abs(low) < 0.03 * high ? "0" : shown(low));
      const picture = svg(chart, "svg", { viewBox: "0 0 1000 100", preserveAspectRatio: "none", role: "img", "aria-label": `${name}, ${unit}, over time` });
      const y = (value) => 98 - 96 * (value - low) / (high - low);
      svg(picture, "line", { class: "zero", x1: 0, x2: 1000, y1: px(y(0)), y2: px(y(0)) });
      svg(picture, "polyline", { class: "curve", points: run.t.map((t, frame) => `${px(1000 * share(t))},${px(y(at(values, frame)))}`).join(" ") });
      const dot = html(chart, "i", { class: "dot" });
      return (frame, t) => {
        number.textContent = `${shown(at(values, frame))} ${unit}`;
        dot.style.left = percent(t);
        dot.style.top = `${px(y(at(values, frame)))}%`;
      };
    });
    const edges = run.t.map((t, i) => (i ? (t + run.t[i - 1]) / 2 : first)).concat(last);
    const contacts = run.joints.flatMap((joint) => joint.contacts.map((contact) => ({ joint, contact })))
      .filter(({ contact }) => every(contact.force).some((force) => common.level(force)));
    contacts.forEach(({ joint, contact }, i) => {
      const [head, chart] = row(i && contacts[i - 1].joint === joint ? "touch" : "touch first");
      html(head, "span", {}, joint.name);
      const side = contact.name || contact.side;
      if (side) html(head, "span", {}, side);
      const picture = svg(chart, "svg", { viewBox: "0 0 1000 10", preserveAspectRatio: "none", role: "img", "aria-label": `contact of ${joint.name}${side ? `, ${side}` : ""}` });
      let start = 0;
      run.t.forEach((_, frame) => {
        const level = common.level(at(contact.force, frame));
        if (frame + 1 < run.t.length && common.level(at(contact.force, frame + 1)) === level) return;
        const [from, to] = [edges[start], edges[frame + 1]].map((t) => 1000 * share(t));
        if (level) svg(picture, "rect", { class: `force-${level}`, x: px(from), width: px(to - from), y: 0, height: 10 });
        start = frame + 1;
      });
    });
    const [unit, axis] = row("ticks");
    unit.textContent = "ms";
    const step = round125((last - first) / 4);
    for (let t = Math.ceil(first / step) * step; t <= last + 1e-9; t += step) {
      html(axis, "span", { style: `left:${percent(t)}` }, shown(t, 6));
    }
    const over = html(box, "div", { class: "over", style: `grid-row: 2 / ${Math.max(rows, 3)}` });
    for (const { t } of run.events || []) html(over, "i", { class: "event", style: `left:${percent(t)}` });
    const now = html(over, "i", { class: "now" });
    over.addEventListener("pointermove", (event) => { if (event.buttons & 1) drag(event); });
    const drag = (event) => {
      const { left: edge, width } = over.getBoundingClientRect();
      seek(first + Math.min(1, Math.max(0, (event.clientX - edge) / width)) * (last - first));
    };
    over.addEventListener("pointerdown", drag);
    const draw = (frame) => {
      const t = at(run.t, frame);
      slider.value = t;
      slider.setAttribute("aria-valuetext", milliseconds(t));
      now.style.left = percent(t);
      plots.forEach((plot) => plot(frame, t));
    };
    return { draw, button, slider };
  };

  // The player ------------------------------------------------------------------------------------------------------------

  const player = (figure, number) => {
    let runs;
    let broken;
    try {
      runs = [JSON.parse(figure.querySelector("script[type='application/json']").textContent)].flat();
      broken = runs.map(fault).find((text) => text);
    } catch (error) {
      broken = error.message;
    }
    if (broken) return void html(figure, "p", { role: "alert" }, `The motion cannot be shown: ${broken}.`);
    const common = { ...survey(runs), number };
    const restFrame = (run) => {
      const force = run.plots.length ? run.plots[0].values : run.t.map((_, frame) =>
        extreme(run.joints.flatMap(({ contacts }) => contacts.map((contact) => at(contact.force, frame))).concat(0), Math.max));
      const late = run.t[run.t.length - 1] > (run.from || 0) ? run.from || 0 : 0;
      const sizes = run.t.map((t, frame) => (t < late ? -Infinity : at(force, frame)));
      return sizes.indexOf(extreme(sizes, Math.max));
    };
    figure.querySelectorAll("noscript").forEach((element) => element.remove());
    const head = html(figure, "div", { class: "top" });
    const heading = html(head, "strong", {});
    let select;
    if (runs.length > 1) {
      html(head, "label", { for: `player-${number}-run` }, "run");
      select = html(head, "select", { id: `player-${number}-run`, "aria-label": "run" });
      runs.forEach((run, i) => html(select, "option", { value: i }, run.label || `${i + 1}`));
    }
    html(head, "label", { for: `player-${number}-rate`, class: "rate" }, "speed");
    const rate = html(head, "select", { id: `player-${number}-rate`, class: "rate", "aria-label": "speed" });
    const clock = html(head, "output", { "aria-live": "off" });
    const body = html(figure, "div", {});
    const swaying = runs.some(({ bodies }) => bodies.some(sways));
    const caption = html(figure, "figcaption", {},
      (swaying ? `Travel is drawn to scale; gaps and the motion within them are enlarged × ${shown(common.play)}. `
        + "A dashed outline is a body as it would be without play, a round mark its centre of mass. "
        : `Bodies are drawn to scale, as the shapes that hold their joints together; gaps and the pins in them are enlarged × ${shown(common.play)}. `
        + "A round mark is a centre of mass. ")
      + "Coloured sides touch their pin; how far they give way is not drawn.");
    html(caption, "span", { class: "keys" }, " Drag over the curves, or use the arrow keys on the slider, to see a moment.");

    let run, draw, controls, chosen = 0, frame = 0, playing = 0, resting = true;
    const calm = window.matchMedia("(prefers-reduced-motion: reduce)");

    const show = (wanted) => {
      frame = Math.min(run.t.length - 1, Math.max(0, Number(wanted) || 0));
      draw(frame);
      const t = at(run.t, frame);
      clock.textContent = milliseconds(t);
      figure.dataset.frame = Math.round(frame);
    };
    const pause = () => {
      if (playing) window.cancelAnimationFrame(playing);
      playing = 0;
      controls.button.textContent = "Play";
    };
    const seek = (time) => { pause(); resting = false; show(frameAt(run.t, time)); };
    // Plays to the end and stays there; from the end, or at first, it plays from the start.
    const play = () => {
      pause();
      const last = run.t.length - 1;
      if (resting || frame >= last) show(0);
      resting = false;
      controls.button.textContent = "Pause";
      let [from, time, drawn] = [undefined, at(run.t, frame), 0];
      const tick = (now) => {
        if (from !== undefined) time += Math.min(now - from, 100) * Number(rate.value);
        from = now;
        // A reader who wants less motion gets two stills a second.
        if (!calm.matches || now - drawn > 500 || time >= run.t[last]) { show(frameAt(run.t, Math.min(time, run.t[last]))); drawn = now; }
        if (time >= run.t[last]) pause(); else playing = window.requestAnimationFrame(tick);
      };
      playing = window.requestAnimationFrame(tick);
    };
    const choose = (index) => {
      if (controls) pause();
      [chosen, run, resting] = [Number(index), runs[index], true];
      if (select) select.value = chosen;
      heading.textContent = runs.length === 1 && run.label ? `${run.title}, ${run.label}` : run.title;
      figure.dataset.run = chosen;
      body.replaceChildren();
      common.hatched = 0;
      const stage = html(body, "div", { class: "stage" });
      const main = html(stage, "div", { class: "main" });
      const pictures = [viewPicture(main, run, 0, common)];
      if (run.bodies.length > 1) {
        const names = html(main, "div", { class: "legend" });
        run.bodies.forEach(({ name }, i) => {
          const key = html(names, "span", { class: "key" });
          const picture = svg(key, "svg", { viewBox: "0 0 20 12", width: 20, height: 12 });
          svg(picture, "rect", { width: 20, height: 12, ...looks(picture, i, common) });
          key.append(` ${name}`);
        });
      }
      const side = html(stage, "div", { class: "beside" });
      if (run.views.length > 1) pictures.push(viewPicture(side, run, 1, common));
      if (run.joints.length) {
        legend(main, common);
        // Many joints get the whole width.
        pictures.push(insetPictures(run.joints.length > 4 ? html(body, "div", { class: "many" }) : side, run, common));
      }
      controls = timeline(body, run, common, seek);
      pictures.push(controls.draw);
      draw = (wanted) => pictures.forEach((picture) => picture(wanted));
      // Speeds at which the run takes from two seconds to a minute, and real time.
      const length = (run.t[run.t.length - 1] - run.t[0]) / 1000;
      const speeds = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10]
        .filter((speed) => speed === 1 || (length / speed >= 2 && length / speed <= 60));
      const usual = speeds.reduce((best, speed) => (Math.abs(Math.log(length / speed / 8)) < Math.abs(Math.log(length / best / 8)) ? speed : best));
      rate.replaceChildren();
      speeds.forEach((speed) => html(rate, "option", { value: speed }, speed === 1 ? "real time" : `× ${speed}: takes ${shown(length / speed, 2)} s`));
      rate.value = usual;
      controls.button.addEventListener("click", () => (playing ? pause() : play()));
      controls.slider.addEventListener("input", () => seek(Number(controls.slider.value)));
      controls.slider.addEventListener("keydown", (event) => {
        const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
        if (!step) return;
        event.preventDefault();
        pause();
        resting = false;
        show(Math.round(frame) + step);
      });
      pause();
      show(restFrame(run));
      // Why it opens there.
      clock.textContent += `: peak ${run.plots.length ? run.plots[0].name : "contact force"}`;
    };
    if (select) select.addEventListener("change", () => choose(Number(select.value)));
    let before;
    const ended = new AbortController();
    const { signal } = ended;
    window.addEventListener("beforeprint", () => { before = frame; pause(); show(restFrame(run)); }, { signal });
    window.addEventListener("afterprint", () => show(before), { signal });
    const end = () => { pause(); ended.abort(); };
    figure.player = { show: (wanted) => { pause(); resting = false; show(wanted); }, choose, play, pause, end };
    choose(0);
  };

  const start = () => document.querySelectorAll("figure.player").forEach((figure) => figure.player || player(figure));
  window.startPlayers = start;
  if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", start); else start();
})();
