// The map of a run: layers, trajectories, the chosen frame.
"use strict";
const canvas = byId("map");
const images = {};
const view = { zoom: 1, x: 0, y: 0, whole: true };  // pan in canvas pixels

const STRIP_PX = 26;  // below the map, so that the scale bar hides no wall
const mapHeight = () => canvas.height - STRIP_PX * devicePixelRatio;

function cellSize() { return (canvas.width / RUN.map.width) * view.zoom; }
function toCanvas(x, y) {
  const size = cellSize();
  const column = (x - RUN.map.origin[0]) / RUN.map.resolution;
  const row = RUN.map.height - (y - RUN.map.origin[1]) / RUN.map.resolution;
  return [view.x + column * size, view.y + row * size];
}

// The truth is wide and pale, so that it is visible on both sides of an estimate on top of it.
function drawPath(context, name, path, stroke) {
  context.strokeStyle = stroke;
  context.globalAlpha = name === "truth" ? 0.5 : 1;
  context.lineWidth = (name === "truth" ? 7 : 2) * devicePixelRatio;
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
  context.globalAlpha = 1;
}

// The corners of an arrowhead, tip first.
function arrowhead(u, v, yaw, length) {
  return [[0, length], [2.5, length * 0.8], [-2.5, length * 0.8]].map(([angle, reach]) => [u + reach * Math.cos(yaw + angle), v - reach * Math.sin(yaw + angle)]);
}

function drawPose(context, path, i, fill) {
  if (!path || path.x[i] === null) return;
  context.beginPath();
  for (const corner of arrowhead(...toCanvas(path.x[i], path.y[i]), path.yaw[i], 11 * devicePixelRatio)) context.lineTo(...corner);
  context.closePath();
  context.fillStyle = fill;
  context.fill();
  context.strokeStyle = "#fff";
  context.lineWidth = devicePixelRatio;
  context.stroke();
}

// The scan nearest to a frame, because not every frame's is kept. None for a frame without a pose.
function scanNear(i, path) {
  if (!path || path.x[i] === null) return null;
  let best = -1;
  for (let k = 0; k < RUN.scans.length; ++k) {
    if (best < 0 || Math.abs(RUN.scans[k].row - i) < Math.abs(RUN.scans[best].row - i)) best = k;
  }
  return best < 0 ? null : RUN.scans[best];
}

// The hits, on the map, of the scan drawn with the selected frame.
const scannedPath = () => RUN.paths.est ?? RUN.paths.online;
function shownHits() {
  const path = scannedPath();
  const scan = shownPaths.has("scan") ? scanNear(currentFrame, path) : null;
  if (!scan || path.x[scan.row] === null) return [];
  const c = Math.cos(path.yaw[scan.row]);
  const s = Math.sin(path.yaw[scan.row]);
  const hits = [];
  for (let k = 0; k + 1 < scan.cm.length; k += 2) {
    const [forward, left] = [scan.cm[k] / 100, scan.cm[k + 1] / 100];
    hits.push([path.x[scan.row] + c * forward - s * left, path.y[scan.row] + s * forward + c * left]);
  }
  return hits;
}

function drawScan(context) {
  const radius = 1.8 * devicePixelRatio;
  context.fillStyle = MAP_COLOURS.scan;
  for (const hit of shownHits()) {
    const [u, v] = toCanvas(...hit);
    context.fillRect(u - radius, v - radius, 2 * radius, 2 * radius);
  }
}

// A round length of at most a quarter of the width.
function scaleBar() {
  const pixelsPerMetre = cellSize() / RUN.map.resolution;
  const wanted = canvas.width / 4 / pixelsPerMetre;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const length = [5, 2, 1].map((f) => f * power).find((l) => l <= wanted) ?? power;
  return { pixels: length * pixelsPerMetre, text: length >= 1 ? `${length} m` : `${Math.round(length * 100)} cm` };
}

function drawScaleBar(context) {
  const { pixels, text } = scaleBar();
  const d = devicePixelRatio;
  const middle = mapHeight() + (STRIP_PX / 2) * d;
  context.fillStyle = "#fff";
  context.fillRect(0, mapHeight(), canvas.width, STRIP_PX * d);
  context.fillStyle = "#111";
  context.fillRect(12 * d, middle - 1.5 * d, pixels, 3 * d);
  context.font = `${13 * d}px system-ui, sans-serif`;
  context.fillText(text, 20 * d + pixels, middle + 5 * d);
}

// Of the difference, cells that could not be seen are paler: so is all beyond the pictures.
const isTwofold = () => currentLayer === "difference" && Boolean(RUN.map.layers.observable);
const beyondColour = () => (isTwofold() ? "#e6e6e6" : "#cdcdcd");

let drawPending = false;
function requestDraw() {
  if (drawPending) return;
  drawPending = true;
  requestAnimationFrame(() => { drawPending = false; drawMap(); });
}

function drawMap() {
  const context = canvas.getContext("2d");
  context.imageSmoothingEnabled = false;
  context.fillStyle = beyondColour();
  context.fillRect(0, 0, canvas.width, canvas.height);
  const image = images[currentLayer];
  if (image?.complete) context.drawImage(image, view.x, view.y, RUN.map.width * cellSize(), RUN.map.height * cellSize());
  for (const [name, , tone] of PATHS) if (shownPaths.has(name)) drawPath(context, name, RUN.paths[name], MAP_COLOURS[tone]);
  drawScan(context);
  for (const [name, , tone] of PATHS) if (shownPaths.has(name)) drawPose(context, RUN.paths[name], currentFrame, MAP_COLOURS[tone]);
  drawScaleBar(context);
}

// Draws what the map shows, with a key of all layers.
function mapSvg() {
  const size = cellSize();
  const pixel = canvas.width / FIGURE_WIDTH;  // of the figure, in canvas pixels
  const height = Math.round(mapHeight() / pixel);
  const at = (x, y) => toCanvas(x, y).map((v) => v / pixel);
  const pathOf = (path) => {
    const known = [...path.x.keys()].filter((i) => path.x[i] !== null);
    return known.map((i, k) => `${k && known[k - 1] === i - 1 ? "L" : "M"}${pointText(at(path.x[i], path.y[i]))}`).join("");
  };
  const shown = PATHS.filter(([name]) => shownPaths.has(name));
  const pen = (name, tone) => ({ stroke: MAP_COLOURS[tone], width: name === "truth" ? 6 : 1.6, opacity: name === "truth" ? 0.5 : 1 });
  const lines = shown.map(([name, , tone]) => {
    const { stroke, width, opacity } = pen(name, tone);
    return svg("path", { d: pathOf(RUN.paths[name]), fill: "none", stroke, "stroke-width": width, "stroke-opacity": opacity, "stroke-linejoin": "round" });
  });
  const hits = shownHits().map((hit) => at(...hit)).map(([u, v]) => svg("rect", { x: (u - 1.2).toFixed(2), y: (v - 1.2).toFixed(2), width: 2.4, height: 2.4, fill: MAP_COLOURS.scan }));
  const heads = shown.map(([name, , tone]) => [RUN.paths[name], MAP_COLOURS[tone]]).filter(([path]) => path.x[currentFrame] !== null).map(([path, fill]) =>
    svg("polygon", { points: arrowhead(...at(path.x[currentFrame], path.y[currentFrame]), path.yaw[currentFrame], 8).map(pointText).join(" "), fill, stroke: "#fff", "stroke-width": 0.7 }));
  const image = svg("image", { href: RUN.map.layers[currentLayer], x: view.x / pixel, y: view.y / pixel, width: (RUN.map.width * size) / pixel, height: (RUN.map.height * size) / pixel, style: "image-rendering: pixelated" });
  const { pixels, text } = scaleBar();
  const bar = [svg("rect", { x: 12, y: height + 11, width: pixels / pixel, height: 3, fill: "#111" }), svg("text", { x: 20 + pixels / pixel, y: height + 17, fill: "#111" }, text)];
  const legend = legendOf([...layerEntries(), ...shown.map(([name, label, tone]) => ({ label, ...pen(name, tone) })), ...frameEntries(hits.length, heads.length)], height + 26);
  return figureSvg(height + 26 + legend.height, svg("svg", { width: FIGURE_WIDTH, height }, svg("rect", { width: FIGURE_WIDTH, height, fill: beyondColour() }), image, ...lines, ...hits, ...heads), ...bar, ...legend.elements);
}
const pointText = (point) => point.map((v) => v.toFixed(2)).join();

// ---- entries of the saved map's key ----
function layerEntries() {
  const square = (fill, x, y) => svg("rect", { x, y: y - 5, width: 10, height: 10, fill, stroke: "#8a8a8a", "stroke-width": 0.7 });
  return [...LAYER_KEYS[currentLayer].map(([tones, label]) => ({ label, mark: (x, y) => tonesOf(tones).map((tone, k) => square(tone, x + (isTwofold() ? 0 : 4) + 10 * k, y)) })),
    ...(isTwofold() ? [{ label: TWOFOLD, mark: () => [] }] : [])];
}

function frameEntries(hits, heads) {
  const label = `of frame ${frames.frame[currentFrame]}`;
  const dots = (x, y) => [3, 9, 15].map((dx) => svg("rect", { x: x + dx - 1.2, y: y - 1.2, width: 2.4, height: 2.4, fill: MAP_COLOURS.scan }));
  const head = (x, y) => [svg("polygon", { points: arrowhead(x + 8, y, 0, 8).map(pointText).join(" "), fill: "#5b6570" })];
  return [...(hits ? [{ label: `scan ${label}`, mark: dots }] : []), ...(heads ? [{ label: `poses ${label}`, mark: head }] : [])];
}

function resizeMap() {
  const width = canvas.clientWidth * devicePixelRatio;
  const middle = [(canvas.width / 2 - view.x) / cellSize(), (mapHeight() / 2 - view.y) / cellSize()];
  const most = Math.max(320, window.innerHeight * 0.85) * devicePixelRatio;
  canvas.width = Math.round(width);
  canvas.height = Math.round(Math.min(most, width * RUN.map.height / RUN.map.width) + STRIP_PX * devicePixelRatio);
  canvas.style.aspectRatio = `${canvas.width} / ${canvas.height}`;
  if (view.whole) { resetView(); return; }
  // The centre stays in place.
  view.x = canvas.width / 2 - middle[0] * cellSize();
  view.y = mapHeight() / 2 - middle[1] * cellSize();
  requestDraw();
}
function resetView() {
  view.whole = true;
  view.zoom = Math.min(1, (mapHeight() / canvas.width) * (RUN.map.width / RUN.map.height));
  view.x = (canvas.width - RUN.map.width * cellSize()) / 2;
  view.y = 0;
  requestDraw();
}

function zoomAt(u, v, factor) {
  const before = view.zoom;
  view.zoom = Math.min(40, Math.max(0.2, view.zoom * factor));
  const ratio = view.zoom / before;
  view.whole = false;
  view.x = u - (u - view.x) * ratio;
  view.y = v - (v - view.y) * ratio;
  requestDraw();
}

function pan(dx, dy) {
  view.x += dx;
  view.y += dy;
  view.whole = false;
  requestDraw();
}

// Keyboard control of the map: arrows move, + and - zoom, 0 shows all.
function moveByKey(event) {
  const step = 0.1 * canvas.width;
  const move = { ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] }[event.key];
  if (move) pan(...move);
  else if (event.key === "+" || event.key === "=") zoomAt(canvas.width / 2, mapHeight() / 2, 1.4);
  else if (event.key === "-") zoomAt(canvas.width / 2, mapHeight() / 2, 1 / 1.4);
  else if (event.key === "0") resetView();
  else return;
  event.preventDefault();
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
  for (const [name, label, tone] of [...PATHS, ...(RUN.scans.length ? [["scan", "Scan of the frame", "scan"]] : [])]) {
    const input = make("input", { type: "checkbox", id: `path-${name}` });
    input.checked = shownPaths.has(name);
    input.addEventListener("change", () => {
      if (input.checked) shownPaths.add(name); else shownPaths.delete(name);
      requestDraw();
    });
    byId("paths").append(make("label", { for: `path-${name}` }, input,
      make("span", { class: name === "truth" ? "swatch beneath" : "swatch", style: `background: ${MAP_COLOURS[tone]}` }), label));
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
    pan((event.clientX - drag[0]) * devicePixelRatio, (event.clientY - drag[1]) * devicePixelRatio);
    drag = [event.clientX, event.clientY];
  });
  canvas.addEventListener("pointerup", () => { drag = null; });
  canvas.addEventListener("pointermove", (event) => {
    const column = (event.offsetX * devicePixelRatio - view.x) / cellSize();
    const row = (event.offsetY * devicePixelRatio - view.y) / cellSize();
    const [x, y] = [RUN.map.origin[0] + column * RUN.map.resolution, RUN.map.origin[1] + (RUN.map.height - row) * RUN.map.resolution];
    byId("map-position").textContent = `x ${fixed(x, 2)} m, y ${fixed(y, 2)} m`;
  });
  canvas.addEventListener("pointerleave", () => { byId("map-position").textContent = ""; });
  canvas.addEventListener("keydown", moveByKey);
  window.addEventListener("resize", resizeMap);
  const zoomButtons = make("div", { class: "no-print map-buttons" },
    make("button", { type: "button", onclick: () => zoomAt(canvas.width / 2, mapHeight() / 2, 1.4) }, "Zoom in"), " ",
    make("button", { type: "button", onclick: () => zoomAt(canvas.width / 2, mapHeight() / 2, 1 / 1.4) }, "Zoom out"), " ",
    make("button", { type: "button", onclick: resetView }, "Whole map"), saveButtons("map", pictureKinds(mapSvg)), make("span", { id: "map-position", class: "muted" }));
  byId("map-note").before(zoomButtons);
  byId("map-note").textContent = `${fixed(RUN.map.resolution * 100, 1)} cm per cell, x to the right, y up. ${RUN.scans.length ? "Red dots: the scan of the chosen frame at its final pose; arrowheads" : "Arrowheads"}: the poses of that frame. Drag to move, Ctrl + wheel or + and - to zoom.`;
  selectLayer(currentLayer);
  resizeMap();
}

// Colours, one beside it for cells that could not be seen where that is told, and the meaning.
const LAYER_KEYS = {
  estimate: [["#000", "occupied"], ["#fff", "free"], ["#cdcdcd", "unknown"]],
  truth: [["#000", "surface in the obstacle band"], ["#fff", "reachable"], ["#cdcdcd", "neither"]],
  difference: [
    [["#000", "#7f7f7f"], "wall, found"], [[MAP_COLOURS.missed, "#eaae7f"], "wall, missed"], [[MAP_COLOURS.invented, "#e5bcd3"], "no wall there"],
    [["#fff", "#fff"], "free"], [["#cdcdcd", "#e6e6e6"], "unknown"],
  ],
  observable: [["#fff", "could be seen"], ["#cdcdcd", "could not"]],
};
const TWOFOLD = "right: the same in cells that could not be seen";
const tonesOf = (tones) => [tones].flat().slice(0, isTwofold() ? 2 : 1);
function selectLayer(name) {
  currentLayer = name;
  const input = byId(`layer-${name}`);
  if (input) input.checked = true;
  canvas.dataset.layer = name;
  const swatches = (tones) => tonesOf(tones).map((tone) => make("i", { style: `background:${tone}` }));
  byId("legend").replaceChildren(...LAYER_KEYS[name].map(([tones, text]) => make("div", {}, ...swatches(tones), text)),
    ...(isTwofold() ? [make("div", {}, TWOFOLD)] : []));
  requestDraw();
}

// ---- frame ----
function selectFrame(i) {
  currentFrame = Math.max(0, Math.min(frameCount - 1, i));
  byId("frame").value = String(currentFrame);
  const row = (name, value) => make("tr", {}, make("td", {}, name), make("td", {}, value));
  const at = (column) => (frames[column] ? frames[column][currentFrame] : null);
  const rows = [row("frame", String(frames.frame[currentFrame])), row("time", `${fixed(frames.stamp_s[currentFrame] - frames.stamp_s[0], 2)} s`)];
  if (!hasPose(currentFrame)) rows.push(row("no pose", `${RUN.input_poses} was lost`));
  if (frames.slam_error_m) rows.push(row("SLAM's error", metres(at("slam_error_m"))), row("error at the time", metres(at("map_error_m"))), row("error at the end", metres(at("est_error_m"))));
  if (at("match_score") !== null) rows.push(row("match score", fixed(at("match_score"), 2)));
  if (at("innovation_forward_m") !== null) {
    rows.push(row("innovation forward, left", `${metres(at("innovation_forward_m"))}, ${metres(at("innovation_left_m"))}`));
    rows.push(row("innovation in heading", `${fixed(at("innovation_yaw_rad") * 180 / Math.PI, 2)}°`));
    rows.push(row("gain forward, left, yaw", `${fixed(at("gain_forward"), 2)}, ${fixed(at("gain_left"), 2)}, ${fixed(at("gain_yaw"), 2)}`));
  }
  byId("frame-values").replaceChildren(...rows);
  for (const plot of allPlots) if (plot.sync === "frames") plot.show(currentFrame);
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
  selectFrame(RUN.worst.length ? RUN.worst[0].row : 0);
}

