// The page of one run.
"use strict";
const RUN = JSON.parse(byId("data").textContent);
const frames = RUN.frames;
const frameCount = frames.frame.length;
// The map is light in both themes, so what is drawn on it keeps its colours.
const MAP_COLOURS = { truth: "#009e73", slam: "#d98c00", online: "#56b4e9", est: "#0072b2", scan: "#d4002a", missed: "#d55e00", invented: "#cc79a7" };
let currentFrame = 0;
let currentLayer = "estimate";

const LAYERS = [
  ["estimate", "Estimate"], ["truth", "Truth"], ["difference", "Difference"],
  ["observable", "Observable"],
].filter(([name]) => RUN.map.layers[name]);
const PATHS = [
  ["truth", "Truth", "truth"], ["slam", "SLAM, as it came in", "slam"],
  ["online", "Estimate at the time", "online"], ["est", "Estimate at the end", "est"],
].filter(([name]) => RUN.paths[name]);
const shownPaths = new Set(PATHS.map(([name]) => name).filter((name) => name !== "online"));

// ---- headline ----
function headline() {
  const cards = [];
  const add = (value, text) => cards.push(make("div", { class: "card" }, make("b", {}, value), make("span", {}, text)));
  const m = RUN.metrics;
  if (m) {
    const seen = m.map.observable ?? m.map.all;
    add(fixed(seen.occupied.f1, 3), `F1 of ${m.map.observable ? "observable " : ""}walls, 1-cell tolerance`);
    add(percent(m.map.coverage), "of the observable cells mapped");
    add(metres(m.map.chamfer_m), "chamfer distance of the walls");
    add(metres(m.trajectory.slam?.mean_euclidean_m), "SLAM's mean error, not aligned");
    add(metres(m.trajectory.est?.mean_euclidean_m), "mean error of the estimate, not aligned");
    add(metres(m.trajectory.est?.ate_rmse_se2_m), "ATE of the estimate, aligned in the plane");
  } else {
    add(String(frameCount), "frames");
    add(String(RUN.mapped_frames), "frames mapped");
    add(`${fixed(RUN.map.width * RUN.map.resolution, 1)} x ${fixed(RUN.map.height * RUN.map.resolution, 1)} m`, "extent");
  }
  byId("headline").append(...cards);
  byId("subtitle").textContent = RUN.subtitle;
}

// ---- map ----
const canvas = byId("map");
const images = {};
const view = { zoom: 1, x: 0, y: 0 };  // pan in canvas pixels

function cellSize() { return (canvas.width / RUN.map.width) * view.zoom; }
function toCanvas(x, y) {
  const size = cellSize();
  const column = (x - RUN.map.origin[0]) / RUN.map.resolution;
  const row = RUN.map.height - (y - RUN.map.origin[1]) / RUN.map.resolution;
  return [view.x + column * size, view.y + row * size];
}

function drawPath(context, path, stroke) {
  context.strokeStyle = stroke;
  context.lineWidth = 2 * devicePixelRatio;
  context.lineJoin = "round";
  context.beginPath();
  let pen = false;
  for (let i = 0; i < path.x.length; ++i) {
    if (path.x[i] === null) { pen = false; continue; }
    const [u, v] = toCanvas(path.x[i], path.y[i]);
    if (pen) context.lineTo(u, v); else context.moveTo(u, v);
    pen = true;
  }
  context.stroke();
}

function drawPose(context, path, i, fill) {
  if (!path || path.x[i] === null) return;
  const [u, v] = toCanvas(path.x[i], path.y[i]);
  const yaw = path.yaw[i];
  const length = 11 * devicePixelRatio;
  const corner = (angle, reach) => [u + reach * Math.cos(yaw + angle), v - reach * Math.sin(yaw + angle)];
  context.beginPath();
  context.moveTo(...corner(0, length));
  context.lineTo(...corner(2.5, length * 0.8));
  context.lineTo(...corner(-2.5, length * 0.8));
  context.closePath();
  context.fillStyle = fill;
  context.fill();
  context.strokeStyle = "#fff";
  context.lineWidth = devicePixelRatio;
  context.stroke();
}

// The scan nearest to a frame: not every frame's is kept.
function scanNear(i) {
  let best = -1;
  for (let k = 0; k < RUN.scans.length; ++k) {
    if (best < 0 || Math.abs(RUN.scans[k].row - i) < Math.abs(RUN.scans[best].row - i)) best = k;
  }
  return best < 0 ? null : RUN.scans[best];
}

function drawScan(context, scan, path, fill) {
  if (!scan || !path || path.x[scan.row] === null) return;
  const c = Math.cos(path.yaw[scan.row]);
  const s = Math.sin(path.yaw[scan.row]);
  const radius = 1.8 * devicePixelRatio;
  context.fillStyle = fill;
  for (let k = 0; k + 1 < scan.cm.length; k += 2) {
    const forward = scan.cm[k] / 100;
    const left = scan.cm[k + 1] / 100;
    const [u, v] = toCanvas(path.x[scan.row] + c * forward - s * left, path.y[scan.row] + s * forward + c * left);
    context.fillRect(u - radius, v - radius, 2 * radius, 2 * radius);
  }
}

function drawScaleBar(context) {
  const pixelsPerMetre = cellSize() / RUN.map.resolution;
  const wanted = canvas.width / 4 / pixelsPerMetre;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const length = [5, 2, 1].map((f) => f * power).find((l) => l <= wanted) ?? power;
  const pixels = length * pixelsPerMetre;
  const d = devicePixelRatio;
  const left = 12 * d;
  const bottom = canvas.height - 14 * d;
  context.fillStyle = "rgba(255,255,255,0.85)";
  context.fillRect(left - 6 * d, bottom - 22 * d, pixels + 12 * d, 30 * d);
  context.fillStyle = "#111";
  context.fillRect(left, bottom, pixels, 3 * d);
  context.font = `${13 * d}px system-ui, sans-serif`;
  context.fillText(length >= 1 ? `${length} m` : `${Math.round(length * 100)} cm`, left, bottom - 6 * d);
}

let drawPending = false;
function requestDraw() {
  if (drawPending) return;
  drawPending = true;
  requestAnimationFrame(() => { drawPending = false; drawMap(); });
}

function drawMap() {
  const context = canvas.getContext("2d");
  context.imageSmoothingEnabled = false;
  context.fillStyle = "#cdcdcd";
  context.fillRect(0, 0, canvas.width, canvas.height);
  const image = images[currentLayer];
  if (image?.complete) context.drawImage(image, view.x, view.y, RUN.map.width * cellSize(), RUN.map.height * cellSize());
  for (const [name, , tone] of PATHS) if (shownPaths.has(name)) drawPath(context, RUN.paths[name], MAP_COLOURS[tone]);
  const scan = scanNear(currentFrame);
  const estimate = RUN.paths.est ?? RUN.paths.online;
  drawScan(context, scan, estimate, MAP_COLOURS.scan);
  for (const [name, , tone] of PATHS) if (shownPaths.has(name)) drawPose(context, RUN.paths[name], currentFrame, MAP_COLOURS[tone]);
  drawScaleBar(context);
}

function resizeMap() {
  const width = canvas.clientWidth * devicePixelRatio;
  const most = Math.max(320, window.innerHeight * 0.85) * devicePixelRatio;
  canvas.width = Math.round(width);
  canvas.height = Math.round(Math.min(most, width * RUN.map.height / RUN.map.width));
  canvas.style.height = `${canvas.height / devicePixelRatio}px`;
  resetView();
}
function resetView() {
  view.zoom = Math.min(1, (canvas.height / canvas.width) * (RUN.map.width / RUN.map.height));
  view.x = (canvas.width - RUN.map.width * cellSize()) / 2;
  view.y = 0;
  requestDraw();
}

function zoomAt(u, v, factor) {
  const before = view.zoom;
  view.zoom = Math.min(40, Math.max(0.2, view.zoom * factor));
  const ratio = view.zoom / before;
  view.x = u - (u - view.x) * ratio;
  view.y = v - (v - view.y) * ratio;
  requestDraw();
}

function initMap() {
  for (const [name, label] of LAYERS) {
    images[name] = new Image();
    images[name].onload = requestDraw;
    images[name].src = RUN.map.layers[name];
    const input = make("input", { type: "radio", name: "layer", value: name, id: `layer-${name}` });
    input.checked = name === currentLayer;
    input.addEventListener("change", () => selectLayer(name));
    byId("layers").append(make("label", { for: `layer-${name}` }, input, ` ${label}`));
  }
  for (const [name, label, tone] of PATHS) {
    const input = make("input", { type: "checkbox", id: `path-${name}` });
    input.checked = shownPaths.has(name);
    input.addEventListener("change", () => {
      if (input.checked) shownPaths.add(name); else shownPaths.delete(name);
      requestDraw();
    });
    byId("paths").append(make("label", { for: `path-${name}` }, input,
      make("span", { class: "swatch", style: `background: ${MAP_COLOURS[tone]}` }), label));
  }
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && !event.shiftKey) return;
    event.preventDefault();
    zoomAt(event.offsetX * devicePixelRatio, event.offsetY * devicePixelRatio, event.deltaY < 0 ? 1.2 : 1 / 1.2);
  }, { passive: false });
  canvas.addEventListener("dblclick", resetView);
  let drag = null;
  canvas.addEventListener("pointerdown", (event) => { drag = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointermove", (event) => {
    if (!drag) return;
    view.x += (event.clientX - drag[0]) * devicePixelRatio;
    view.y += (event.clientY - drag[1]) * devicePixelRatio;
    drag = [event.clientX, event.clientY];
    requestDraw();
  });
  canvas.addEventListener("pointerup", () => { drag = null; });
  window.addEventListener("resize", resizeMap);
  const zoomButtons = make("div", { class: "no-print" },
    make("button", { type: "button", onclick: () => zoomAt(canvas.width / 2, canvas.height / 2, 1.4) }, "Zoom in"), " ",
    make("button", { type: "button", onclick: () => zoomAt(canvas.width / 2, canvas.height / 2, 1 / 1.4) }, "Zoom out"), " ",
    make("button", { type: "button", onclick: resetView }, "Whole map"));
  byId("map-note").before(zoomButtons);
  byId("map-note").textContent = `${fixed(RUN.map.resolution * 100, 1)} cm a cell. Red dots: the scan of the chosen frame at its final pose. Drag to move, Ctrl + wheel to zoom.`;
  selectLayer(currentLayer);
  resizeMap();
}

const LAYER_KEYS = {
  estimate: [["#000", "occupied"], ["#fff", "free"], ["#cdcdcd", "unknown"]],
  truth: [["#000", "surface in the obstacle band"], ["#fff", "reachable"], ["#cdcdcd", "neither"]],
  difference: [["#000", "wall, found"], [MAP_COLOURS.missed, "wall, missed"], [MAP_COLOURS.invented, "no wall there"], ["#fff", "free"], ["#cdcdcd", "unknown; paler: could not be seen"]],
  observable: [["#fff", "could be seen"], ["#cdcdcd", "could not"]],
};
function selectLayer(name) {
  currentLayer = name;
  const input = byId(`layer-${name}`);
  if (input) input.checked = true;
  canvas.dataset.layer = name;
  byId("legend").replaceChildren(...LAYER_KEYS[name].map(([tone, text]) =>
    make("div", {}, make("i", { style: `background:${tone}` }), text)));
  requestDraw();
}

// ---- frame ----
function selectFrame(i) {
  currentFrame = Math.max(0, Math.min(frameCount - 1, i));
  byId("frame").value = String(currentFrame);
  const row = (name, value) => make("tr", {}, make("td", {}, name), make("td", {}, value));
  const at = (column) => (frames[column] ? frames[column][currentFrame] : null);
  const rows = [row("frame", String(frames.frame[currentFrame])), row("time", `${fixed(frames.stamp_s[currentFrame] - frames.stamp_s[0], 2)} s`)];
  if (frames.slam_error_m) rows.push(row("SLAM's error", metres(at("slam_error_m"))), row("error at the time", metres(at("map_error_m"))), row("error at the end", metres(at("est_error_m"))));
  if (at("match_score") !== null) rows.push(row("match score", fixed(at("match_score"), 2)));
  if (at("innovation_forward_m") !== null) {
    rows.push(row("innovation", `${metres(at("innovation_forward_m"))}, ${metres(at("innovation_left_m"))}`));
    rows.push(row("gain", `${fixed(at("gain_forward"), 2)}, ${fixed(at("gain_left"), 2)}, ${fixed(at("gain_yaw"), 2)}`));
  }
  byId("frame-values").replaceChildren(...rows);
  requestDraw();
}

function initFrames() {
  const slider = byId("frame");
  slider.max = String(Math.max(0, frameCount - 1));
  slider.addEventListener("input", () => selectFrame(Number(slider.value)));
  let timer = null;
  byId("play").addEventListener("click", () => {
    if (timer) { clearInterval(timer); timer = null; } else {
      timer = setInterval(() => selectFrame(currentFrame + 1 < frameCount ? currentFrame + Math.ceil(frameCount / 600) : 0), 33);
    }
    byId("play").textContent = timer ? "Stop" : "Play";
    byId("play").setAttribute("aria-pressed", String(Boolean(timer)));
  });
  selectFrame(0);
}

// ---- plots ----
function initPlots() {
  const x = frames.stamp_s.map((t) => t - frames.stamp_s[0]);
  const has = (column) => frames[column] && frames[column].some((v) => v !== null);
  const degrees = (column) => frames[column].map((v) => (v === null ? null : v * 180 / Math.PI));
  const centimetres = (column) => frames[column].map((v) => (v === null ? null : v * 100));
  const add = (title, series) => {
    if (series.length) drawPlot(byId("plots"), { title, x, xLabel: "time (s)", series, sync: "frames", onCursor: selectFrame });
  };
  if (has("slam_error_m")) {
    add("Distance from the truth in the plane (cm)", [
      { label: "SLAM", values: centimetres("slam_error_m"), colour: "slam", digits: 2, unit: "cm" },
      { label: "estimate at the time", values: centimetres("map_error_m"), colour: "online", digits: 2, unit: "cm" },
      { label: "estimate at the end", values: centimetres("est_error_m"), colour: "est", digits: 2, unit: "cm" },
    ]);
  }
  if (has("innovation_forward_m")) {
    add("Innovation: match against prediction (cm)", [
      { label: "forward", values: centimetres("innovation_forward_m"), colour: "est", digits: 2, unit: "cm" },
      { label: "left", values: centimetres("innovation_left_m"), colour: "slam", digits: 2, unit: "cm" },
    ]);
    add("Innovation in heading (°)", [{ label: "yaw", values: degrees("innovation_yaw_rad"), colour: "truth", digits: 3, unit: "°" }]);
    add("Gain: share of the innovation taken", [
      { label: "forward", values: frames.gain_forward, colour: "est" },
      { label: "left", values: frames.gain_left, colour: "slam" },
      { label: "yaw", values: frames.gain_yaw, colour: "truth" },
    ]);
  }
  if (has("match_score")) add("Match score", [{ label: "share of beams the map explains", values: frames.match_score, colour: "est" }]);
  if (has("beams")) add("Beams with a hit", [{ label: "beams", values: frames.beams, colour: "est", digits: 0 }]);
}

// ---- worst frames ----
function initWorst() {
  if (!RUN.worst.length) { byId("worst-section").remove(); return; }
  byId("worst-note").textContent = RUN.worst_by;
  const head = ["frame", "time s", "SLAM's error", "at the time", "at the end", "match score", "innovation", ""];
  const rows = RUN.worst.map((i) => {
    const at = (column) => (frames[column] ? frames[column][i] : null);
    const innovation = at("innovation_forward_m") === null ? null : Math.hypot(at("innovation_forward_m"), at("innovation_left_m"));
    return [String(frames.frame[i]), fixed(frames.stamp_s[i] - frames.stamp_s[0], 2), metres(at("slam_error_m")),
      metres(at("map_error_m")), metres(at("est_error_m")), fixed(at("match_score"), 2), metres(innovation),
      make("button", { type: "button", class: "no-print", onclick: () => { selectFrame(i); byId("map-title").scrollIntoView({ behavior: "smooth" }); } }, "Show")];
  });
  const table = tableOf(head, rows);
  table.id = "worst";
  byId("worst").replaceWith(table);
}

// ---- samples, numbers, settings ----
function initSamples() {
  if (!RUN.samples.length) { byId("samples-section").remove(); return; }
  for (const sample of RUN.samples) {
    const figure = (source, text) => make("figure", {}, make("img", { src: source, alt: `${text} of frame ${sample.frame}`, loading: "lazy" }),
      make("figcaption", {}, `Frame ${sample.frame}: ${text}`));
    const row = make("div", { class: "samples-row" });
    if (sample.colour) row.append(figure(sample.colour, "colour"));
    row.append(figure(sample.depth, "depth with the scan"));
    byId("samples").append(row);
  }
}

function initNumbers() {
  const m = RUN.metrics;
  if (!m) { byId("numbers-section").remove(); return; }
  const t = m.trajectory;
  const names = [["slam", "SLAM"], ["online", "estimate at the time"], ["est", "estimate at the end"]].filter(([n]) => t[n]);
  const row = (label, pick) => [label, ...names.map(([n]) => fixed(pick(t[n]), 4))];
  byId("numbers").append(make("h3", {}, "Trajectory, metres"), make("div", { class: "scroll" }, tableOf(["", ...names.map(([, label]) => label)], [
    row("mean distance in xy, not aligned", (s) => s.mean_euclidean_m),
    row("ATE rmse in xy, not aligned", (s) => s.ate_rmse_m),
    row("ATE rmse in xy, first pose aligned", (s) => s.ate_rmse_origin_m),
    row("ATE rmse in xy, SE(2) aligned", (s) => s.ate_rmse_se2_m),
    row("mean distance in xyz, not aligned", (s) => s.mean_euclidean_xyz_m),
    row("ATE rmse in xyz, SE(3) aligned", (s) => s.ate_rmse_se3_m),
    row("relative error a frame, rmse", (s) => s.rpe_frame_rmse_m),
    row("relative error a metre, rmse", (s) => s.rpe_metre_rmse_m),
  ])));
  const cells = [["observable cells", m.map.observable], ["all cells", m.map.all]].filter(([, s]) => s);
  const rows = [];
  for (const [label, s] of cells) {
    for (const [tolerance, at] of [["0", "tolerance_0"], ["1", null], ["2", "tolerance_2"]]) {
      const walls = at ? s.occupied[at] : s.occupied;
      const free = at ? s.free[at] : s.free;
      rows.push([`${label}, tolerance ${tolerance}`, ...[walls.precision, walls.recall, walls.f1, walls.iou, free.precision, free.recall, free.f1].map((v) => fixed(v, 3))]);
    }
  }
  byId("numbers").append(make("h3", {}, "Map, tolerance in cells"), make("div", { class: "scroll" },
    tableOf(["", "wall precision", "recall", "F1", "IoU", "free precision", "recall", "F1"], rows)));
  byId("numbers").append(make("div", { class: "scroll" }, tableOf(["", "chamfer", "Hausdorff 95 %", "coverage"],
    cells.map(([label, s]) => [label, metres(s.chamfer_m), metres(s.hausdorff95_m), percent(s.coverage)]))));
}

initTheme();
headline();
initMap();
initFrames();
initPlots();
initWorst();
initSamples();
initNumbers();
byId("settings").textContent = RUN.settings;
document.documentElement.dataset.ready = "true";
