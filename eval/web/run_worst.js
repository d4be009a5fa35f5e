// The worst frames of a run: a table, and for each the scan in the map it was matched against and
// how well it would have fitted at the poses around.
"use strict";

// Prediction, match, estimate and truth have different shapes, so that they are distinguishable without
// colours and where they overlap.
const MARKS = [
  ["prediction", "prediction", "slam", "circle"], ["match", "match", "scan", "cross"],
  ["estimate", "estimate at the time", "est", "dot"], ["truth", "truth", "truth", "diamond"],
];

function drawMark(context, shape, u, v, tone) {
  const size = 5;
  const outline = () => {
    context.beginPath();
    if (shape === "circle") context.arc(u, v, size, 0, 2 * Math.PI);
    if (shape === "dot") context.arc(u, v, 2.5, 0, 2 * Math.PI);
    if (shape === "cross") { context.moveTo(u - 4, v - 4); context.lineTo(u + 4, v + 4); context.moveTo(u - 4, v + 4); context.lineTo(u + 4, v - 4); }
    if (shape === "diamond") { context.moveTo(u, v - 7); context.lineTo(u + 7, v); context.lineTo(u, v + 7); context.lineTo(u - 7, v); context.closePath(); }
  };
  for (const [stroke, width] of [["#fff", 4.5], [tone, 2]]) {
    outline();
    context.strokeStyle = stroke;
    context.lineWidth = width;
    context.stroke();
  }
}

function markKey() {
  return make("p", { class: "muted marks" }, ...MARKS.filter(([name]) => RUN.worst.some((w) => w[name])).flatMap(([, label, tone, shape]) => [
    paintedCanvas(18, 18, label, (context) => drawMark(context, shape, 9, 9, MAP_COLOURS[tone])), make("span", {}, label)]));
}

// ---- the scan in the map it was matched against ----
function scanPicture(worst, size) {
  const map = worst.map;
  const image = new Image();
  const strip = 20;  // below the map, so that the scale bar hides no wall
  const canvas = paintedCanvas(size, size + strip, `Frame ${frames.frame[worst.row]}: its scan in the map at that time`, (context) => {
    context.clearRect(0, 0, size, size + strip);
    const cell = Math.min(size / map.width, size / map.height);
    const left = (size - cell * map.width) / 2;
    const top = (size - cell * map.height) / 2;
    const at = (x, y) => [left + (x - map.origin[0]) / map.resolution * cell, top + (map.height - (y - map.origin[1]) / map.resolution) * cell];
    context.imageSmoothingEnabled = false;
    context.fillStyle = "#cdcdcd";
    context.fillRect(0, 0, size, size);
    if (image.complete && image.naturalWidth) context.drawImage(image, left, top, cell * map.width, cell * map.height);
    const scan = RUN.scans.find((s) => s.row === worst.row);
    const [x0, y0, yaw] = worst.estimate;
    context.fillStyle = MAP_COLOURS.scan;
    for (let k = 0; scan && k + 1 < scan.cm.length; k += 2) {
      const [forward, side] = [scan.cm[k] / 100, scan.cm[k + 1] / 100];
      const [u, v] = at(x0 + Math.cos(yaw) * forward - Math.sin(yaw) * side, y0 + Math.sin(yaw) * forward + Math.cos(yaw) * side);
      context.fillRect(u - 1.2, v - 1.2, 2.4, 2.4);
    }
    for (const [name, , tone, shape] of MARKS) if (worst[name]) drawMark(context, shape, ...at(worst[name][0], worst[name][1]), MAP_COLOURS[tone]);
    const metre = cell / map.resolution;
    const length = [1, 10, 0.1].find((l) => l * metre > 8 && l * metre < 0.8 * size) ?? 1;
    context.fillStyle = colour("ink");
    context.fillRect(0, size + 8, length * metre, 3);
    context.fillText(`${length} m`, length * metre + 5, size + 13);
  });
  image.onload = canvas.redraw;
  image.src = map.image;
  return canvas;
}

// ---- match surface ----
function surfacePicture(worst, size, say) {
  const { step_m: step, half_steps: half, residual } = worst.surface;
  const side = 2 * half + 1;
  const low = Math.min(...residual);
  const high = Math.max(...residual);
  const cells = make("canvas", { width: side, height: side });
  const pixels = cells.getContext("2d").createImageData(side, side);
  residual.forEach((value, k) => {
    const row = side - 1 - Math.floor(k / side);  // the largest y on top
    pixels.data.set([...viridis(1 - (value - low) / (high - low || 1)), 255], 4 * (row * side + k % side));
  });
  cells.getContext("2d").putImageData(pixels, 0, 0);
  const edge = { left: 34, right: 8, top: 8, bottom: 34 };
  const inner = size - edge.left - edge.right;
  const reach = (half + 0.5) * step;
  const at = (dx, dy) => [edge.left + (dx + reach) / (2 * reach) * inner, edge.top + (reach - dy) / (2 * reach) * inner];
  const canvas = paintedCanvas(size, size, `Frame ${frames.frame[worst.row]}: how well its scan fits around the estimate`, (context) => {
    context.imageSmoothingEnabled = true;
    context.drawImage(cells, edge.left, edge.top, inner, inner);
    context.fillStyle = colour("muted");
    context.textAlign = "center";
    for (const cm of [-20, -10, 0, 10, 20].filter((v) => Math.abs(v) / 100 <= reach)) {
      const [u, v] = at(cm / 100, cm / 100);
      context.textAlign = "center";
      context.fillText(String(cm), u, size - 20);
      context.textAlign = "right";
      context.fillText(String(cm), edge.left - 4, v + 4);
    }
    context.textAlign = "center";
    context.fillText("x from the estimate (cm)", edge.left + inner / 2, size - 5);
    context.save();
    context.translate(9, edge.top + inner / 2);
    context.rotate(-Math.PI / 2);
    context.fillText("y (cm)", 0, 0);
    context.restore();
    for (const [name, , tone, shape] of MARKS) {
      if (!worst[name]) continue;
      const clip = (value) => Math.max(-reach, Math.min(reach, value));
      const [dx, dy] = [worst[name][0] - worst.estimate[0], worst[name][1] - worst.estimate[1]];
      drawMark(context, shape, ...at(clip(dx), clip(dy)), MAP_COLOURS[tone]);
    }
  });
  canvas.addEventListener("pointermove", (event) => {
    const shrink = size / canvas.clientWidth;
    const column = Math.floor((event.offsetX * shrink - edge.left) / inner * side);
    const row = side - 1 - Math.floor((event.offsetY * shrink - edge.top) / inner * side);
    const inside = column >= 0 && column < side && row >= 0 && row < side;
    say(inside ? `x ${fixed((column - half) * step * 100, 0)} cm, y ${fixed((row - half) * step * 100, 0)} cm: residual ${fixed(residual[row * side + column], 3)}` : "");
  });
  canvas.addEventListener("pointerleave", () => say(""));
  return canvas;
}

// ---- the residual over the heading ----
function yawPicture(worst, width, height) {
  const { yaw_step_deg: step, yaw_residual: values } = worst.surface;
  const half = (values.length - 1) / 2;
  const low = Math.min(...values);
  const high = Math.max(...values);
  const edge = { left: 34, right: 8, top: 6, bottom: 32 };
  const u = (degrees) => edge.left + (degrees / step + half) / (values.length - 1) * (width - edge.left - edge.right);
  const v = (value) => edge.top + (high - value) / (high - low || 1) * (height - edge.top - edge.bottom);
  return paintedCanvas(width, height, `Frame ${frames.frame[worst.row]}: residual over heading`, (context) => {
    context.strokeStyle = colour("grid");
    context.strokeRect(edge.left, edge.top, width - edge.left - edge.right, height - edge.top - edge.bottom);
    for (const [name, , tone] of MARKS) {
      if (!worst[name]) continue;
      const turn = (worst[name][2] - worst.estimate[2]) * 180 / Math.PI;
      const degrees = turn - 360 * Math.round(turn / 360);
      if (Math.abs(degrees) > half * step) continue;
      context.strokeStyle = MAP_COLOURS[tone];
      context.lineWidth = 1.5;
      context.beginPath(); context.moveTo(u(degrees), edge.top); context.lineTo(u(degrees), height - edge.bottom); context.stroke();
    }
    context.strokeStyle = colour("ink");
    context.lineWidth = 1.5;
    context.beginPath();
    values.forEach((value, i) => context.lineTo(u((i - half) * step), v(value)));
    context.stroke();
    context.fillStyle = colour("muted");
    context.textAlign = "right";
    context.fillText(fixed(high, 2), edge.left - 3, edge.top + 9);
    context.fillText(fixed(low, 2), edge.left - 3, height - edge.bottom);
    context.textAlign = "center";
    for (const degrees of [-4, -2, 0, 2, 4]) if (Math.abs(degrees) <= half * step) context.fillText(String(degrees), u(degrees), height - 18);
    context.fillText("heading from the estimate (°)", edge.left + (width - edge.left - edge.right) / 2, height - 4);
  });
}

function worstCard(worst) {
  const i = worst.row;
  const at = (column) => (frames[column] ? frames[column][i] : null);
  const errors = at("est_error_m") === null ? `match score ${fixed(at("match_score"), 2)}` : `${metres(at("est_error_m"))} off at the end, ${metres(at("map_error_m"))} at the time`;
  const pictures = make("div", { class: "worst-pictures" });
  if (worst.surface) {
    const low = Math.min(...worst.surface.residual);
    const high = Math.max(...worst.surface.residual);
    const scale = `Residual ${fixed(low, 2)} (yellow, best) to ${fixed(high, 2)}`;
    const caption = make("figcaption", {}, scale);
    pictures.append(
      make("figure", {}, scanPicture(worst, 250), make("figcaption", {}, "Scan in the map at that time")),
      make("figure", {}, surfacePicture(worst, 250, (text) => { caption.textContent = text || scale; }), caption),
      make("figure", {}, yawPicture(worst, Math.max(250, Math.min(508, byId("worst-cards").clientWidth - 32)), 96), make("figcaption", {}, "Residual over heading")));
  } else {
    pictures.append(make("p", { class: "muted" }, worst.no_match));
  }
  return make("article", { class: "worst-card" },
    make("h3", {}, `Frame ${frames.frame[i]}, ${fixed(times[i], 2)} s: ${errors}`), pictures);
}

function initWorst() {
  if (!RUN.worst.length) { byId("worst-section").remove(); return; }
  byId("worst-note").textContent = RUN.worst_by;
  if (RUN.method === "surfel") {
    byId("worst-how").append(" Scans were matched against surfels, which resolve walls finer than these cells: bright spots may lie half a cell from where scans matched.");
  }
  const errors = [["SLAM's error", "slam_error_m"], ["error at the time", "map_error_m"], ["error at the end", "est_error_m"]].filter(([, name]) => frames[name]);
  const head = ["frame", "time", ...errors.map(([label]) => label), "match score", "innovation", ""];
  const rows = RUN.worst.map(({ row: i }) => {
    const at = (column) => (frames[column] ? frames[column][i] : null);
    const innovation = at("innovation_forward_m") === null ? null : Math.hypot(at("innovation_forward_m"), at("innovation_left_m"));
    return [String(frames.frame[i]), `${fixed(times[i], 2)} s`, ...errors.map(([, name]) => metres(at(name))), fixed(at("match_score"), 2), metres(innovation),
      make("button", { type: "button", class: "no-print", "aria-label": `Show frame ${frames.frame[i]} on the map`,
        onclick: () => { selectFrame(i); byId("map-title").scrollIntoView({ behavior: "smooth" }); } }, "On the map")];
  });
  const table = tableOf(head, rows);
  table.id = "worst";
  byId("worst").replaceWith(table);
  if (!RUN.worst.some((w) => w.surface)) {
    byId("worst-how").textContent = [...new Set(RUN.worst.map((w) => w.no_match))].join(" ");
    return;
  }
  byId("worst-cards").before(markKey());
  byId("worst-cards").append(...RUN.worst.map(worstCard));
}
