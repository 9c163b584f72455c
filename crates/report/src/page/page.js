"use strict";
// The script of a report: unpacks the numbers, draws the view and the plots. Nothing is loaded from anywhere.
(async () => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const element = (id) => document.getElementById(id);
  const INK = "#1f2329", SOFT = "#626a76", GRID = "#e6e9ed";
  const LINES = ["#26547c", "#d1495b", "#2a9d6f", "#e09f3e", "#7b5ea7", "#3d9cc4", "#8a6d3b", "#555b66"];
  const VIRIDIS = [[0, "#440154"], [0.125, "#472d7b"], [0.25, "#3b528b"], [0.375, "#2c728e"], [0.5, "#21918c"],
    [0.625, "#28ae80"], [0.75, "#5ec962"], [0.875, "#addc30"], [1, "#fde725"]];
  const STATUS = [[0, "#9ebcda"], [1 / 3, "#9ebcda"], [1 / 3, "#0072b2"], [2 / 3, "#0072b2"], [2 / 3, "#d55e00"], [1, "#d55e00"]];

  // numbers as in the tables
  const short = (value, digits = 5) => {
    if (value === null || value === undefined || Number.isNaN(value)) return "–";
    if (value === 0) return "0";
    const power = Math.floor(Math.log10(Math.abs(value)));
    const text = power >= -3 && power < 6 ? String(Number(value.toPrecision(digits)))
      : value.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e");
    return text.replace(/-/g, "−");
  };

  // what Rust has packed
  const packed = {};
  document.querySelectorAll("script[data-chunk]").forEach((script) => { packed[script.dataset.chunk] = script; });
  const unpack = async (name) => {
    const script = packed[name];
    const text = atob(script.textContent.trim());
    const bytes = Uint8Array.from(text, (character) => character.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    const plain = new Uint8Array(await new Response(stream).arrayBuffer());
    const kind = script.dataset.kind;
    if (kind === "text") return new TextDecoder().decode(plain);
    const width = kind === "u16" ? 2 : 4, n = plain.length / width;
    const words = new Uint8Array(plain.length);
    for (let k = 0; k < width; k++) for (let i = 0; i < n; i++) words[i * width + k] = plain[k * n + i];
    if (kind === "f32") return new Float32Array(words.buffer);
    const whole = kind === "u16" ? new Uint16Array(words.buffer) : new Uint32Array(words.buffer);
    for (let i = 1; i < n; i++) whole[i] = whole[i] + whole[i - 1];
    return whole;
  };

  const note = (text) => {
    const place = document.createElement("p");
    place.className = "note";
    place.textContent = text;
    return place;
  };
  const failed = (error) => {
    document.querySelector("main").prepend(note("Plots and view cannot be drawn in this browser: " + error));
    document.body.dataset.ready = "failed";
  };
  try {
    const source = document.createElement("script");
    source.textContent = await unpack("plotly");
    document.head.append(source);
  } catch (error) { failed(error); return; }
  const SETTINGS = { displaylogo: false, responsive: true, modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d", "toggleSpikelines",
    "hoverClosest3d", "hoverClosestCartesian", "hoverCompareCartesian"] };
  const layout = (title, x, y, more = {}) => ({
    title: { text: title, font: { size: 14, color: INK }, x: 0.01, xanchor: "left" },
    font: { family: "system-ui, Segoe UI, Roboto, Arial, sans-serif", size: 12, color: SOFT },
    margin: { l: 62, r: 14, t: 38, b: 44 }, paper_bgcolor: "#fff", plot_bgcolor: "#fff", colorway: LINES,
    legend: { orientation: "h", x: 1, xanchor: "right", y: 1.02, yanchor: "bottom", font: { size: 11 } },
    xaxis: { title: { text: x }, gridcolor: GRID, zerolinecolor: "#c5cbd3", ...more.xaxis },
    yaxis: { title: { text: y }, gridcolor: GRID, zerolinecolor: "#c5cbd3", exponentformat: "power", ...more.yaxis },
    ...more.layout,
  });
  const plot = (id, traces, form) => { const place = typeof id === "string" ? element(id) : id; if (place) return Plotly.react(place, traces, form, SETTINGS); };
  const unitOf = (unit) => (unit ? ` in ${unit}` : "");

  // ---- histories
  const columns = (history) => Object.fromEntries((history?.columns ?? []).map((column) => [column.name, column]));
  const own = columns(data.history), other = columns(data.other);
  const line = (x, y, name, dashed, color) => ({ x, y, name, type: "scatter", mode: x.length > 60 ? "lines" : "lines+markers",
    marker: { size: 5, color }, line: { width: 1.8, dash: dashed ? "dash" : "solid", color } });
  // both runs, B with broken lines
  const lines = (x, names, label) => names.flatMap((name, k) => {
    const color = LINES[k % LINES.length];
    const both = [];
    if (own[x] && own[name]) both.push(line(own[x].values, own[name].values, label(name) + (data.other ? " A" : ""), false, color));
    if (other[x] && other[name]) both.push(line(other[x].values, other[name].values, label(name) + " B", true, color));
    return both;
  });
  const drawHistories = () => {
    const time = own.time?.values ?? [];
    if (!time.length) return;
    const names = data.history.columns.map((column) => column.name).filter((name) => name !== "step");
    const across = element("history-x"), up = element("history-y");
    const size = (name) => Math.max(0, ...own[name].values.map((v) => Math.abs(v ?? 0)));
    const forces = names.filter((name) => /force_[xyz]$/.test(name));
    const largest = forces.reduce((best, name) => (best && size(best) >= size(name) ? best : name), undefined);
    const moved = names.filter((name) => /displacement|_u[xyz]$|\.u[xyz]$/.test(name) && size(name) > 0)
      .reduce((best, name) => (best && size(best) >= size(name) ? best : name), undefined);
    for (const name of names) {
      across.add(new Option(name, name, false, name === (moved && largest ? moved : "time")));
      up.add(new Option(name, name, false, name === (largest ?? names.find((n) => !["time", "increment"].includes(n)))));
    }
    const draw = () => {
      const x = across.value, ys = [...up.selectedOptions].map((option) => option.value);
      const unit = ys.length ? own[ys[0]].unit : "";
      plot("plot-history", lines(x, ys, (name) => name),
        layout(`${ys.length === 1 ? ys[0] : "history"} over ${x}`, x + unitOf(own[x].unit), (ys.length === 1 ? ys[0] : "") + unitOf(unit)));
    };
    across.onchange = up.onchange = draw;
    draw();
    const place = element("plot-contacts");
    // all boxes are there before the first plot is drawn into one: they share the width
    const boxes = [];
    const add = (traces, how) => {
      const box = document.createElement("div");
      box.className = "plot";
      place.append(box);
      boxes.push([box, traces, how]);
    };
    for (const contact of data.contacts) {
      const groups = [["force", ["force_x", "force_y", "force_z"]], ["largest pressure", ["pressure_max"]],
        ["area", ["area_stick", "area_slip", "area_open"]], ["smallest gap and largest slip", ["gap_min", "slip_max"]]];
      for (const [title, quantities] of groups) {
        const shown = quantities.map((quantity) => `${contact}.${quantity}`).filter((name) => own[name]);
        if (!shown.length) continue;
        add(lines("time", shown, (name) => name.slice(contact.length + 1)),
          layout(`${contact}: ${title}`, "time", unitOf(own[shown[0]].unit).trim()));
      }
    }
    // the user's own columns
    const known = /^(time|step|increment|iterations)$/;
    const rest = names.filter((name) => !known.test(name) && !data.contacts.some((contact) => name.startsWith(contact + ".")));
    for (const name of rest.slice(0, 12)) {
      add(lines("time", [name], () => name), layout(name, "time", unitOf(own[name].unit).trim()));
    }
    for (const [box, traces, how] of boxes) plot(box, traces, how);
  };

  // ---- convergence
  const drawConvergence = () => {
    const c = data.convergence;
    if (!c) return;
    const time = own.time?.values ?? [];
    const sizes = time.map((t, k) => t - (k ? time[k - 1] : 0));
    const cuts = c.cutbacks;
    plot("plot-size", [line(time, sizes, "increment", false, LINES[0]),
      { x: cuts.map((cut) => cut.time), y: cuts.map((cut) => cut.size), text: cuts.map((cut) => cut.why), name: "cut-back", type: "scatter",
        mode: "markers", marker: { symbol: "x", size: 10, color: LINES[1] } }],
    layout("Size of increments", "time", "size", { yaxis: Math.max(...sizes) > 20 * Math.min(...sizes) ? { type: "log", exponentformat: "power", dtick: 1 } : { rangemode: "tozero" } }));
    plot("plot-iterations", [{ x: time.map((t, k) => t - 0.5 * sizes[k]), y: own.iterations?.values ?? [], width: sizes.map((s) => 0.9 * s), type: "bar", marker: { color: LINES[0] } }],
      layout("Iterations of each increment", "time", "iterations"));
    // residuals: one line per attempt
    const n = c.residual.length, number = Array.from({ length: n }, (_, k) => k + 1);
    const x = [], y = [], text = [], hue = [];
    for (let k = 0; k < n; k++) {
      if (k && c.iteration[k] <= c.iteration[k - 1]) { x.push(null); y.push(null); text.push(""); hue.push(0); }
      x.push(number[k]); y.push(c.residual[k] > 0 ? c.residual[k] : null); hue.push(c.attempt[k]);
      text.push(`${c.step[k]}, increment ${c.increment[k]}, attempt ${c.attempt[k]}, iteration ${c.iteration[k]}` +
        (c.worst[k] === null ? "" : `<br>largest at node ${c.worst[k]}: click to see it`));
    }
    const drawn = plot("plot-residual", [{ x, y, text, type: "scatter", mode: "lines+markers", line: { width: 1, color: "#9fb3c8" },
      marker: { size: 5, color: hue.map((attempt) => (attempt > 1 ? LINES[1] : LINES[0])) }, hovertemplate: "%{text}<br>%{y:.3e}<extra></extra>" }],
    layout("Residual of every iteration (red: repeated attempts; click a point to see its worst node)", "iteration of the run", "relative to the force scale",
      { yaxis: { type: "log", exponentformat: "power" } }));
    drawn?.then((place) => place.on("plotly_click", (event) => {
      const worst = c.worst[event.points[0].x - 1];
      if (worst ?? false) { showNode(worst); element("view").scrollIntoView(); }
    }));
    plot("plot-flips", [
      { x: number, y: c.flips, name: "changes of status", type: "bar", marker: { color: LINES[3] } },
      { x: number, y: c.closed, name: "closed", type: "scatter", mode: "lines", line: { color: LINES[0], width: 1.2, shape: "hv" } }],
    layout("Contact points that are closed, and changes of status", "iteration of the run", "points"));
  };
  const drawQuality = () => {
    if (!data.quality) return;
    plot("plot-quality", [{ x: data.quality.map((_, k) => (k + 0.5) / 10), y: data.quality, type: "bar", width: 0.09, marker: { color: LINES[0] } }],
      layout("Scaled Jacobian", "1 ideal, 0 flat", "elements", { yaxis: { type: Math.max(...data.quality) > 1000 ? "log" : "linear" } }));
  };

  // ---- view
  const v = data.view, kept = {};
  let showNode = () => {};
  const chunk = async (name) => (kept[name] ??= await unpack(name));
  const startView = async () => {
    if (!v) return;
    if (!document.createElement("canvas").getContext("webgl")) {
      element("view").querySelectorAll(".controls").forEach((one) => { one.hidden = true; });
      element("picked").replaceChildren(note("This browser has no WebGL, which the view needs" + (element("still") ? ": a picture of the last frame is shown." : ".")));
      return;
    }
    const [points, labels, triangles, parts, edges, segments] = await Promise.all(["points", "labels", "triangles", "parts", "edges", "lines"].map(chunk));
    const n = v.nnode, nt = v.ntriangle;
    const fields = Object.fromEntries(v.fields.map((field) => [field.name, field]));
    const state = { frame: v.frames.length - 1, warp: 1, show: "whole", own: false, picked: -1, hidden: new Set(), playing: 0 };
    const corner = [0, 1, 2].map((k) => Array.from({ length: nt }, (_, t) => triangles[3 * t + k]));

    // values of a field in a frame, component by component
    const numbers = async (field, frame) => {
      const all = await chunk("field-" + field.name);
      const count = (field.cells ? nt : n) * field.components.length;
      const some = all.subarray(frame * count, (frame + 1) * count);
      if (!field.steps) return some;
      const [low, high] = field.steps;
      return Float64Array.from(some, (q) => (q === 65535 ? NaN : low + q * (high - low) / 65534));
    };
    const scalar = (field, component, all) => {
      const m = field.cells ? nt : n;
      if (component >= 0) return Array.from(all.subarray(component * m, (component + 1) * m));
      if (!field.vector) return Array.from(all.subarray(0, m));
      return Array.from({ length: m }, (_, i) => Math.hypot(all[i], all[m + i], all[2 * m + i]));
    };

    // the choices
    const choice = element("field");
    for (const field of v.fields) {
      if (field.range) choice.add(new Option(field.name + (field.vector ? " (size)" : ""), field.name + "|-1"));
      if (field.components.length > 1) field.components.forEach((component, k) => choice.add(new Option(`${field.name}.${component}`, `${field.name}|${k}`)));
    }
    const first = ["von_mises", "quality", "displacement"].find((name) => fields[name]);
    if (first) choice.value = first + "|-1";
    const slider = element("frame");
    slider.max = v.frames.length - 1;
    slider.value = state.frame;
    const edgesBox = element("edges");
    edgesBox.checked = v.nedge > 0 && v.nedge <= 30000;
    edgesBox.disabled = v.nedge === 0;
    const hasContact = v.fields.some((field) => field.contact);
    if (!hasContact || v.plane) element("label-show").hidden = true;
    if (v.frames.length < 2) ["play", "frame"].forEach((id) => { element(id).disabled = true; });
    if (v.parts.length > 1 && v.parts.length <= 16) {
      v.parts.forEach((name, part) => {
        const label = document.createElement("label"), box = document.createElement("input");
        box.type = "checkbox";
        box.checked = true;
        box.onchange = () => { box.checked ? state.hidden.delete(part) : state.hidden.add(part); draw(); };
        label.append(box, " " + name);
        element("parts").append(label);
      });
    }

    // the box that all frames fit in
    const positions = async (frame) => {
      const at = [0, 1, 2].map((k) => Array.from(points.subarray(k * n, (k + 1) * n)));
      if (!fields.displacement || state.warp === 0) return at;
      const moved = await numbers(fields.displacement, frame);
      for (let k = 0; k < 3; k++) for (let i = 0; i < n; i++) { const u = moved[k * n + i]; if (u === u) at[k][i] += state.warp * u; }
      return at;
    };
    const box = async () => {
      const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
      for (const frame of new Set([0, v.frames.length >> 1, v.frames.length - 1])) {
        const at = await positions(frame);
        for (let k = 0; k < 3; k++) for (const x of at[k]) { if (x < low[k]) low[k] = x; if (x > high[k]) high[k] = x; }
      }
      const size = Math.max(...[0, 1, 2].map((k) => high[k] - low[k])) || 1;
      return [0, 1, 2].map((k) => { const least = 0.02 * size, middle = 0.5 * (low[k] + high[k]), half = Math.max(0.5 * (high[k] - low[k]), least); return [middle - 1.02 * half, middle + 1.02 * half]; });
    };
    let ranges = await box();
    // as large as the picture lets it be: about two units are visible from top to bottom
    const ratio = () => {
      const sizes = ranges.map(([a, b]) => b - a), { eye, up } = view();
      const length = Math.hypot(eye.x, eye.y, eye.z), d = [eye.x / length, eye.y / length, eye.z / length], u = [up.x, up.y, up.z];
      const cross = (p, q) => [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
      let right = cross(u, d);
      right = right.map((x) => x / (Math.hypot(...right) || 1));
      const extent = (axis) => axis.reduce((sum, x, k) => sum + Math.abs(x) * sizes[k], 0);
      const place = element("stage"), wide = 0.7 * 2.03 * place.clientWidth / (place.clientHeight || 1);
      const f = Math.min(wide / extent(right), 1.78 / extent(cross(d, right)));
      return { x: f * sizes[0], y: f * sizes[1], z: f * sizes[2] };
    };
    const view = () => {
      if (v.plane) return { eye: { x: 0, y: 0, z: 2 }, up: { x: 0, y: 1, z: 0 }, center: { x: 0, y: 0, z: 0 }, projection: { type: "orthographic" } };
      return { eye: { x: -0.85, y: -1.25, z: 0.8 }, up: { x: 0, y: 0, z: 1 }, center: { x: 0, y: 0, z: 0 }, projection: { type: "orthographic" } };
    };
    let camera = view();

    const scene = () => element("stage")._fullLayout.scene._scene;
    // plotly draws all objects twice to find the one under the mouse, and again at each move of the mouse
    const withoutPlotlyPicks = () => {
      for (const object of scene().glplot.objects) { object.drawPick = undefined; object.pick = () => null; }
    };
    // the pixels of the nodes in the canvas, and their depths
    const projected = (at) => {
      const { glplot, dataScale } = scene(), { model, view, projection } = glplot.cameraParams, { width, height } = glplot.canvas.getBoundingClientRect();
      const by = (m, [x, y, z, w]) => [0, 1, 2, 3].map((k) => m[k] * x + m[4 + k] * y + m[8 + k] * z + m[12 + k] * w);
      return Array.from({ length: n }, (_, i) => {
        const point = [at[0][i] * dataScale[0], at[1][i] * dataScale[1], at[2][i] * dataScale[2], 1];
        const [x, y, z, w] = by(projection, by(view, by(model, point)));
        return [(0.5 + 0.5 * x / w) * width, (0.5 - 0.5 * y / w) * height, z / w];
      });
    };
    // the present places of the nodes, and the triangles that a click can hit: each layer before the next one
    let targets = { at: [[], [], []], layers: [] };
    // the node at a pixel of the canvas: a corner of the foremost triangle there, or one that is not far; -1 for none
    const nodeAt = (x, y) => {
      const place = projected(targets.at);
      const apart = (i) => Math.hypot(place[i][0] - x, place[i][1] - y);
      const nearest = (best, i) => (best < 0 || apart(i) < apart(best) ? i : best);
      for (const layer of targets.layers) {
        let depth = Infinity, hit = -1;
        for (const t of layer) {
          const [a, b, c] = [place[corner[0][t]], place[corner[1][t]], place[corner[2][t]]];
          const bx = b[0] - a[0], by = b[1] - a[1], cx = c[0] - a[0], cy = c[1] - a[1], area = bx * cy - cx * by;
          const q = ((x - a[0]) * cy - cx * (y - a[1])) / area, r = (bx * (y - a[1]) - (x - a[0]) * by) / area;
          if (!(q >= 0 && r >= 0 && q + r <= 1)) continue;
          const z = a[2] + q * (b[2] - a[2]) + r * (c[2] - a[2]);
          if (z < depth) { depth = z; hit = t; }
        }
        if (hit >= 0) return corner.map((nodes) => nodes[hit]).reduce(nearest, -1);
      }
      const around = targets.layers.flatMap((layer) => layer.flatMap((t) => corner.map((nodes) => nodes[t])));
      const found = [...around, ...segments].reduce(nearest, -1);
      return found >= 0 && apart(found) < 8 ? found : -1;
    };

    const light = { ambient: v.plane ? 1 : 0.78, diffuse: v.plane ? 0 : 0.4, specular: 0.03, roughness: 0.9, facenormalsepsilon: 0, vertexnormalsepsilon: 0 };
    const draw = async () => {
      const [name, which] = choice.value.split("|"), field = fields[name], component = Number(which), frame = state.frame;
      const [at, all] = await Promise.all([positions(frame), field ? numbers(field, frame) : []]);
      const values = field ? scalar(field, component, all) : [];
      const given = field && (component >= 0 && field.components.length > 1 ? field.ranges[component] : field.range);
      let [low, high] = given ?? [0, 1];
      if (element("range").value === "frame") {
        low = Infinity; high = -Infinity;
        for (const x of values) { if (x < low) low = x; if (x > high) high = x; }
      }
      if (!(low <= high)) { low = 0; high = 1; }
      const isStatus = name === "contact_status";
      const colors = {
        colorscale: isStatus ? STATUS : VIRIDIS, cmin: isStatus ? -0.5 : low, cmax: isStatus ? 2.5 : high > low ? high : low + (Math.abs(low) || 1) * 1e-9,
        colorbar: { title: { text: `${name}${component >= 0 && field.components.length > 1 ? "." + field.components[component] : ""}${unitOf(field?.unit)}`, side: "right" }, thickness: 14, len: 0.8, outlinewidth: 0,
          ...(isStatus ? { tickvals: [0, 1, 2], ticktext: ["open", "stick", "slip"] } : { exponentformat: "power", nticks: 8 }) },
      };
      // triangles with values in colour, others grey
      const coloured = [], grey = [];
      const seen = (t) => !state.hidden.has(parts[t]);
      for (let t = 0; t < nt; t++) {
        if (!seen(t)) continue;
        const known = field && (field.cells ? values[t] === values[t]
          : values[corner[0][t]] === values[corner[0][t]] && values[corner[1][t]] === values[corner[1][t]] && values[corner[2][t]] === values[corner[2][t]]);
        (known && !(v.plane && field.contact) ? coloured : grey).push(t);
      }
      const some = (which) => ({ i: which.map((t) => corner[0][t]), j: which.map((t) => corner[1][t]), k: which.map((t) => corner[2][t]) });
      const mesh = { type: "mesh3d", x: at[0], y: at[1], z: at[2], flatshading: true, lighting: light, lightposition: { x: -20000, y: -60000, z: 90000 } };
      const traces = [];
      const show = v.plane || !field?.contact ? "whole" : state.show;
      if (coloured.length) traces.push({ ...mesh, ...some(coloured), intensity: field.cells ? coloured.map((t) => values[t]) : values.map((x) => (x === x ? x : low)),
        intensitymode: field.cells ? "cell" : "vertex", showscale: true, ...colors });
      if (grey.length && show !== "contact") traces.push({ ...mesh, ...some(grey), color: show === "ghost" ? "#b9c1cc" : "#d4d8de", opacity: show === "ghost" ? 0.18 : 1 });
      // lines lie a little outside of the surface, or it would hide them
      const lift = [0, 1, 2].map((k) => at[k].slice()), step = 0.0015 * Math.max(...ranges.map(([a, b]) => b - a));
      if (v.plane) { for (let i = 0; i < n; i++) lift[2][i] += 6 * step; } else if (edgesBox.checked) {
        const normal = [new Float64Array(n), new Float64Array(n), new Float64Array(n)];
        for (let t = 0; t < nt; t++) {
          const [a, b, c] = [corner[0][t], corner[1][t], corner[2][t]];
          const d = [0, 1, 2].map((k) => at[k][b] - at[k][a]), e = [0, 1, 2].map((k) => at[k][c] - at[k][a]);
          const cross = [d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2], d[0] * e[1] - d[1] * e[0]], size = Math.hypot(...cross) || 1;
          for (const i of [a, b, c]) for (let k = 0; k < 3; k++) normal[k][i] += cross[k] / size;
        }
        for (let i = 0; i < n; i++) { const size = Math.hypot(normal[0][i], normal[1][i], normal[2][i]) || 1; for (let k = 0; k < 3; k++) lift[k][i] += step * normal[k][i] / size; }
      }
      const strokes = (pairs, more) => {
        const x = [], y = [], z = [], node = [];
        for (let e = 0; e < pairs.length; e += 2) {
          for (const i of [pairs[e], pairs[e + 1]]) { x.push(lift[0][i]); y.push(lift[1][i]); z.push(lift[2][i]); node.push(i); }
          x.push(null); y.push(null); z.push(null); node.push(-1);
        }
        return { type: "scatter3d", mode: "lines", x, y, z, showlegend: false, ...more(node) };
      };
      if (edgesBox.checked && show === "whole") {
        let drawn = edges;
        if (state.hidden.size) {
          const visible = new Uint8Array(n);
          for (let t = 0; t < nt; t++) if (seen(t)) for (let k = 0; k < 3; k++) visible[corner[k][t]] = 1;
          drawn = Array.from({ length: edges.length / 2 }, (_, e) => e).filter((e) => visible[edges[2 * e]] && visible[edges[2 * e + 1]]).flatMap((e) => [edges[2 * e], edges[2 * e + 1]]);
        }
        traces.push(strokes(drawn, () => ({ line: { color: "#6c7484", width: 1 } })));
      }
      const onLines = (pairs, width) => traces.push(strokes(pairs, (node) => ({ line: { width, color: node.map((i) => (i < 0 ? low : values[i])), ...colors, showscale: !coloured.length } })));
      if (segments.length && field && !field.cells) onLines(segments, 6);
      if (v.plane && field?.contact) {
        const of = [];
        for (let e = 0; e < edges.length; e += 2) if (values[edges[e]] === values[edges[e]] && values[edges[e + 1]] === values[edges[e + 1]]) of.push(edges[e], edges[e + 1]);
        if (of.length) onLines(of, 9);
      }
      if (name === "contact_normal") {
        const length = 0.05 * Math.max(...ranges.map(([a, b]) => b - a)), x = [], y = [], z = [];
        for (let i = 0; i < n; i++) {
          if (Math.hypot(all[i], all[n + i], all[2 * n + i]) < 0.5) continue;
          [x, y, z].forEach((to, k) => to.push(at[k][i], at[k][i] + length * all[k * n + i], null));
        }
        traces.push({ type: "scatter3d", mode: "lines", x, y, z, showlegend: false, line: { color: "#d1495b", width: 3 } });
      }
      if (state.picked >= 0) {
        const i = state.picked;
        traces.push({ type: "scatter3d", mode: "markers+text", x: [at[0][i]], y: [at[1][i]], z: [at[2][i]], text: [String(labels[i])], textposition: "top center",
          textfont: { color: "#b3261e", size: 13 }, marker: { size: 4, color: "#b3261e" }, showlegend: false });
      }
      const axis = (k) => ({ range: ranges[k], visible: true, title: { text: "xyz"[k] }, showspikes: false, showbackground: false, gridcolor: "#eef0f3", zeroline: false,
        nticks: 5, tickfont: { size: 10, color: "#8a919c" } });
      await plot("stage", traces, {
        margin: { l: 0, r: 0, t: 0, b: 0 }, paper_bgcolor: "#fff", uirevision: "view", font: { family: "system-ui, Segoe UI, Roboto, Arial, sans-serif", size: 12, color: SOFT },
        scene: { xaxis: axis(0), yaxis: axis(1), zaxis: v.plane ? { ...axis(2), visible: false } : axis(2), aspectmode: "manual", aspectratio: ratio(),
          camera, dragmode: v.plane ? "pan" : "turntable", hovermode: false, uirevision: "view" },
      });
      withoutPlotlyPicks();
      targets = { at, layers: show === "ghost" ? [coloured, grey] : [show === "contact" ? coloured : coloured.concat(grey)] };
      const { number, time } = v.frames[frame] ?? { number: 0, time: 0 };
      element("time").textContent = data.check ? "initial" : `${number}: t = ${short(time, 4)}`;
      await showPicked();
      document.body.dataset.drawn = String(Number(document.body.dataset.drawn ?? 0) + 1);
    };

    const showPicked = async () => {
      const place = element("picked"), i = state.picked;
      if (i < 0) return;
      const rows = [["x", points[i]], ["y", points[n + i]], ["z", points[2 * n + i]]].map(([name, value]) => ({ name, value, key: "Points." + name }));
      for (const field of v.fields) {
        if (field.cells) continue;
        const all = await numbers(field, state.frame);
        field.components.forEach((component, k) => rows.push({ name: component ? `${field.name}.${component}` : field.name, value: all[k * n + i], key: component ? `${field.name}.${component}` : field.name }));
      }
      const table = document.createElement("table");
      for (const { name, value, key } of rows) {
        if (value !== value) continue;
        const row = table.insertRow(), head = document.createElement("th"), cell = row.insertCell();
        head.textContent = name;
        row.prepend(head);
        cell.className = "number";
        cell.dataset.field = key;
        cell.dataset.value = String(value);
        cell.textContent = name === "contact_status" ? ["open", "stick", "slip"][value] ?? short(value) : short(value);
      }
      const head = document.createElement("h3");
      head.textContent = `Node ${labels[i]}`;
      const part = document.createElement("p");
      part.className = "hint";
      part.textContent = v.parts.length > 1 ? v.parts[parts[Math.floor(triangles.indexOf(i) / 3)]] ?? "" : "";
      place.dataset.node = String(labels[i]);
      place.dataset.frame = String(v.frames[state.frame]?.number ?? 0);
      place.replaceChildren(head, part, table);
    };
    showNode = (label) => {
      const i = labels.indexOf(Number(label));
      element("pick").value = label;
      if (i < 0) {
        element("picked").replaceChildren(note(`Node ${label} is not on the surface that is shown.`));
        return;
      }
      state.picked = i;
      return draw();
    };

    // at most one drawing at a time, the last one wins
    let busy = false, again = false;
    const redraw = async () => {
      if (busy) { again = true; return; }
      busy = true;
      do { again = false; await draw(); } while (again);
      busy = false;
    };
    choice.onchange = () => {
      const field = fields[choice.value.split("|")[0]];
      if (!state.own && field?.contact && !v.plane) { state.show = "ghost"; element("show").value = "ghost"; }
      redraw();
    };
    element("show").onchange = () => { state.own = true; state.show = element("show").value; redraw(); };
    element("range").onchange = edgesBox.onchange = redraw;
    slider.oninput = () => { state.frame = Number(slider.value); redraw(); };
    element("warp").onchange = async () => { const warp = Number(element("warp").value); state.warp = Number.isFinite(warp) ? warp : 1; ranges = await box(); redraw(); };
    element("pick").onchange = () => showNode(element("pick").value);
    element("reset").onclick = () => { camera = view(); Plotly.relayout("stage", { "scene.camera": camera }); };
    element("play").onclick = () => {
      if (state.playing) { clearInterval(state.playing); state.playing = 0; element("play").textContent = "▶"; return; }
      element("play").textContent = "❚❚";
      state.playing = setInterval(() => { if (busy) return; state.frame = (state.frame + 1) % v.frames.length; slider.value = state.frame; redraw(); }, 350);
    };
    element("still")?.remove();
    await redraw();
    // a click, not the end of a drag
    const stage = element("stage");
    let pressed = [0, 0];
    stage.addEventListener("pointerdown", (event) => { pressed = [event.clientX, event.clientY]; });
    stage.addEventListener("click", (event) => {
      const { clientX: x, clientY: y, target } = event;
      if (target !== scene().glplot.canvas || Math.hypot(x - pressed[0], y - pressed[1]) > 4) return;
      const { left, top } = target.getBoundingClientRect(), node = nodeAt(x - left, y - top);
      if (node < 0) return;
      state.picked = node;
      element("pick").value = labels[node];
      redraw();
    });
  };
  document.addEventListener("click", (event) => {
    const link = event.target.closest("a.node");
    if (link) showNode(link.dataset.node);
  });
  // A printed page shows what is folded, and plots scaled to the columns of A4. Its layout is not known yet, and Plotly would
  // draw after it.
  const PRINTED = [["#stage", 470], [".plot.tall, .plot.wide", 670], [".plot", 328]];
  const eachPlot = (act) => document.querySelectorAll(".js-plotly-plot").forEach((place) => act(place));
  addEventListener("beforeprint", () => {
    document.querySelectorAll("details").forEach((one) => { one.open = true; });
    eachPlot((place) => { place.style.zoom = PRINTED.find(([places]) => place.matches(places))[1] / place.clientWidth; });
  });
  addEventListener("afterprint", () => eachPlot((place) => { place.style.zoom = ""; }));

  try {
    if (!data.check) { drawHistories(); drawConvergence(); drawQuality(); }
    await startView();
    document.body.dataset.ready = "yes";
  } catch (error) { failed(error); throw error; }
})();
