// A metric over two axes, with the best value of one axis for each value of the other.
"use strict";
const heat = { x: -1, y: -1, held: {}, cell: [0, 0] };
// An axis with too many values, as in a random sweep, is divided into bins with equal numbers of points.
const MOST_ROWS = 60;
const BINS = 12;
const HEAT_AXES = AXES.map((axis, i) => {
  if (!axis.numeric || axis.texts.length <= MOST_ROWS) return { labels: axis.labels, of: (value) => value, binned: false };
  const sorted = POINTS.map((p) => p.values[i]).sort((a, b) => a - b);
  const ends = [...Array(BINS + 1).keys()].map((k) => sorted[Math.min(sorted.length - 1, Math.floor(k * sorted.length / BINS))]);
  const short = (value) => String(Number(axis.numbers[value].toPrecision(2)));
  return {
    labels: [...Array(BINS).keys()].map((k) => `${short(ends[k])}–${short(ends[k + 1])}`), binned: true,
    of: (value) => { let bin = 0; while (bin + 1 < BINS && value >= ends[bin + 1]) ++bin; return bin; },
  };
});
const heatAxes = () => AXES.map((axis, i) => i).filter((i) => AXES[i].texts.length > 1);

function initHeat() {
  const axes = heatAxes();
  const crossed = axes.some((i) => axes.some((k) => isCrossed(i, k)));
  if (axes.length < 2 || (!crossed && !axes.some((i) => HEAT_AXES[i].binned))) { byId("heat-section").remove(); return; }
  heat.y = mainAxis();  // its best values form the line; larger values are at the top
  heat.x = axes.find((i) => isCrossed(i, heat.y)) ?? axes.find((i) => i !== heat.y);
  changed.push(drawHeat);
  themeListeners.push(drawHeat);  // also for paper
  window.addEventListener("resize", drawHeat);
  drawHeat();
}

// Mean of the metric, index of the point and of the best row, by column and row.
function heatCells(free) {
  const [columns, rows] = [HEAT_AXES[heat.x].labels.length, HEAT_AXES[heat.y].labels.length];
  const cells = Array.from({ length: columns }, () => Array(rows).fill(null));
  const sums = new Map();
  POINTS.forEach((point, i) => {
    if (!fits(point.values, heat.held, free) || !isNumber(metric.mean[i])) return;
    const [c, r] = [HEAT_AXES[heat.x].of(point.values[heat.x]), HEAT_AXES[heat.y].of(point.values[heat.y])];
    const key = `${c} ${r}`;
    const [sum, count] = sums.get(key) ?? [0, 0];
    sums.set(key, [sum + metric.mean[i], count + 1]);
    cells[c][r] = { point: i };
  });
  for (const [key, [sum, count]] of sums) {
    const [c, r] = key.split(" ").map(Number);
    cells[c][r].mean = sum / count;
    cells[c][r].count = count;
  }
  return cells;
}

// For each column the best row and, if the statistics computed it, the ends of its interval.
function bestOfColumns(cells) {
  const lines = AXES[heat.y].numeric ? linesAlong(heat.y) : [];
  const numberRow = (value) => AXES[heat.y].numbers.reduce((best, v, k, all) => (Math.abs(v - value) < Math.abs(all[best] - value) ? k : best), 0);
  return cells.map((column) => {
    if (metric.better === "neither") return null;
    let row = -1;
    column.forEach((cell, r) => { if (cell && (row < 0 || isBetter(cell.mean, column[row].mean))) row = r; });
    if (row < 0) return null;
    const line = lines.find((l) => column[row].count === 1 && l.points.includes(column[row].point));
    if (line?.alike) return null;
    return line ? { row, low: numberRow(line.low), high: numberRow(line.high) } : { row };
  });
}

// Better is yellower; without a better direction, higher is.
const heatColour = (share) => (metric.better === "lower" ? 1 - share : share);

// What paints it: {height, paint(context), cellAt(x, y)}. In a file no cell is chosen.
function heatPainting(cells, best, width, inFile) {
  const [columns, rows] = [cells.length, cells[0].length];
  const longest = Math.max(...HEAT_AXES[heat.y].labels.map((t) => t.length));
  const means = cells.flat().filter(Boolean).map((c) => c.mean);
  const sorted = [...means].sort((a, b) => a - b);
  const keyTexts = heatKeyValues(sorted).map(heatKeyText);
  const edge = { left: Math.min(130, 34 + TEXT_WIDTH * longest), right: 40 + 7 * Math.max(9, ...keyTexts.map((t) => t.length)), top: 10, bottom: 46 };
  const height = Math.max(160, Math.min(460, rows * 34)) + edge.top + edge.bottom;
  const [w, h] = [(width - edge.left - edge.right) / columns, (height - edge.top - edge.bottom) / rows];
  // Colours follow the rank of the value, so that a few bad corners do not make everything else one colour.
  const rank = (value) => (sorted.length < 2 ? 0.5 : sorted.filter((v) => v < value).length / (sorted.length - 1));
  const shade = (value) => viridis(heatColour(rank(value)));
  const u = (c) => edge.left + c * w;
  const v = (r) => height - edge.bottom - (r + 1) * h;
  const every = (count, size, need) => Math.max(1, Math.ceil(need / size), Math.ceil(count / 40));
  const paint = (context) => {
    cells.forEach((column, c) => column.forEach((cell, r) => {
      context.fillStyle = cell ? rgb(shade(cell.mean)) : colour("panel");
      context.fillRect(u(c), v(r), Math.ceil(w), Math.ceil(h));
      if (!cell) crossOut(context, u(c), v(r), w, h);
    }));
    // Marks stand in the middle of their cells; numbers give way to them.
    const marks = markSegments(best, (c) => u(c) + w / 2, (r) => v(r) + h / 2);
    drawBestMarks(context, best, (c) => u(c) + w / 2, (r) => v(r) + h / 2);
    cells.forEach((column, c) => column.forEach((cell, r) => {
      if (!cell || w < 44 || h < 16) return;
      const [red, green, blue] = shade(cell.mean);
      const text = String(rounded(cell.mean, 3));
      const place = numberPlaces(text, u(c), v(r), w, h).find((one) => !marks.some((mark) => crosses(mark, one.box)));
      if (!place) return;
      context.textAlign = place.align;
      context.strokeStyle = rgb([red, green, blue]);
      context.lineWidth = 4;
      context.strokeText(text, place.x, place.y);
      context.fillStyle = 0.3 * red + 0.6 * green + 0.1 * blue > 120 ? "#000" : "#fff";
      context.fillText(text, place.x, place.y);
    }));
    context.strokeStyle = colour("ink");
    context.lineWidth = 2;
    if (!inFile) context.strokeRect(u(heat.cell[0]) + 1, v(heat.cell[1]) + 1, w - 2, h - 2);
    context.fillStyle = colour("muted");
    context.textAlign = "center";
    // Numbers are thinned out until they fit; names are shortened.
    const name = (text) => (AXES[heat.x].numeric ? text : shortened(text, Math.max(6, Math.floor((w - 8) / TEXT_WIDTH))));
    HEAT_AXES[heat.x].labels.map(name).forEach((text, c) => { if (c % every(columns, w, TEXT_WIDTH * text.length + 8) === 0) context.fillText(text, u(c) + w / 2, height - edge.bottom + 15); });
    context.fillText(AXES[heat.x].key, edge.left + (width - edge.left - edge.right) / 2, height - 8);
    context.textAlign = "right";
    HEAT_AXES[heat.y].labels.forEach((text, r) => { if (r % every(rows, h, 14) === 0) context.fillText(shortened(text, Math.floor((edge.left - 30) / TEXT_WIDTH) + 1), edge.left - 5, v(r) + h / 2 + 4); });
    context.save();
    context.translate(11, edge.top + (height - edge.top - edge.bottom) / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText(AXES[heat.y].key, 0, 0);
    context.restore();
    const key = [width - edge.right + 14, edge.top, height - edge.top - edge.bottom];
    drawHeatKey(context, ...key, keyTexts);
    if (cells.flat().includes(null)) sayCrossedOut(context, key[0], key[1] + key[2] + 14);
  };
  return { height, paint, cellAt: (x, y) => [Math.floor((x - edge.left) / w), rows - 1 - Math.floor((y - edge.top) / h)] };
}
const heatTitle = (label) => `${label} over ${AXES[heat.x].key} and ${AXES[heat.y].key}`;

function heatPicture(cells, best, width) {
  const { height, paint, cellAt } = heatPainting(cells, best, width, false);
  return Object.assign(paintedCanvas(width, height, `${heatTitle(metric.label)}. Arrow keys move the chosen cell.`, paint), { cellAt });
}

function heatSvg(cells, best, free) {
  return inLight(() => {
    const { height, paint } = heatPainting(cells, best, FIGURE_WIDTH, true);
    const context = new SvgContext();
    paint(context);
    return titledFigure(`${heatTitle(metricLabel())}${heldTitle(heat.held, free)}${SWEEP.of ? ` (${SWEEP.of})` : ""}.${heatKeyNote(best)}`, { height, parts: context.parts });
  });
}

// Marks a cell without a value.
function crossOut(context, left, top, w, h) {
  context.strokeStyle = colour("line");
  context.lineWidth = 1;
  context.beginPath();
  context.moveTo(left, top);
  context.lineTo(left + w, top + h);
  context.moveTo(left, top + h);
  context.lineTo(left + w, top);
  context.stroke();
}

function sayCrossedOut(context, left, top) {
  context.fillStyle = colour("panel");
  context.fillRect(left, top, 14, 12);
  crossOut(context, left, top, 14, 12);
  context.strokeRect(left, top, 14, 12);
  context.fillStyle = colour("muted");
  context.textAlign = "left";
  context.fillText("no result", left + 18, top + 10);
}

// A line only along numeric axes: names have no order.
function drawBestMarks(context, best, u, v) {
  const line = (draw) => {
    for (const [stroke, width] of [["#fff", 5], ["#d4002a", 2.5]]) {
      context.strokeStyle = stroke;
      context.lineWidth = width;
      context.beginPath();
      draw();
      context.stroke();
    }
  };
  if (AXES[heat.x].numeric) line(() => best.forEach((b, c) => { if (b) context.lineTo(u(c), v(b.row)); }));
  best.forEach((b, c) => {
    if (!b) return;
    if (isNumber(b.low) && b.low !== b.high) line(() => { context.moveTo(u(c), v(b.low)); context.lineTo(u(c), v(b.high)); });
    context.beginPath();
    context.arc(u(c), v(b.row), 5, 0, 2 * Math.PI);
    context.fillStyle = "#d4002a";
    context.fill();
    context.strokeStyle = "#fff";
    context.lineWidth = 1.5;
    context.stroke();
  });
}

// What is drawn of them, as straight pieces [x, y, x, y]; a dot as its two diameters.
function markSegments(best, u, v) {
  const DOT = 7;
  const known = [...best.keys()].filter((c) => best[c]);
  const dots = known.flatMap((c) => { const [x, y] = [u(c), v(best[c].row)]; return [[x - DOT, y, x + DOT, y], [x, y - DOT, x, y + DOT]]; });
  const bars = known.filter((c) => isNumber(best[c].low)).map((c) => [u(c), v(best[c].low), u(c), v(best[c].high)]);
  const line = AXES[heat.x].numeric ? known.slice(1).map((c, k) => [u(known[k]), v(best[known[k]].row), u(c), v(best[c].row)]) : [];
  return [...dots, ...bars, ...line];
}

// Where a cell's number may stand, the usual place first: {x, y of its foot, align, box: its left, top, right, bottom}.
function numberPlaces(text, left, top, w, h) {
  const [MARGIN, GAP, ASCENT] = [6, 2, 9];
  const length = TEXT_WIDTH * text.length;
  const beside = MARGIN + length + 8 <= w / 2;
  const heights = h < 30 ? [top + h / 2 + 4] : beside ? [top + h / 2 + 4, top + 12, top + h - 4] : [top + 12, top + h - 4];
  const sides = beside ? [["left", left + MARGIN], ["right", left + w - MARGIN]] : [["center", left + w / 2]];
  return sides.flatMap(([align, x]) => heights.map((y) => {
    const from = align === "left" ? x : align === "right" ? x - length : x - length / 2;
    return { x, y, align, box: [from - GAP, y - ASCENT - GAP, from + length + GAP, y + GAP] };
  }));
}

// Whether a straight piece passes through a box: what the box's four sides leave of it (Liang and Barsky 1984).
function crosses([x0, y0, x1, y1], [left, top, right, bottom]) {
  let [from, to] = [0, 1];
  for (const [step, room] of [[x0 - x1, x0 - left], [x1 - x0, right - x0], [y0 - y1, y0 - top], [y1 - y0, bottom - y0]]) {
    if (step === 0 && room < 0) return false;
    if (step < 0) from = Math.max(from, room / step);
    if (step > 0) to = Math.min(to, room / step);
  }
  return from <= to;
}

// Minimum, median and maximum; `sorted` ascending.
const heatKeyValues = (sorted) => [0, 0.5, 1].map((share) => sorted[Math.floor(share * (sorted.length - 1))] ?? 0);
const heatKeyText = (value) => withUnit(rounded(value, 3));

function drawHeatKey(context, left, top, height, texts) {
  for (let i = 0; i < height; ++i) {
    const share = 1 - i / height;
    context.fillStyle = rgb(viridis(heatColour(share)));
    context.fillRect(left, top + i, 14, 1.5);
  }
  context.fillStyle = colour("muted");
  context.textAlign = "left";
  for (const [i, share] of [0, 0.5, 1].entries()) {
    context.fillText(texts[i], left + 18, top + (1 - share) * height + (share === 1 ? 10 : share === 0 ? 0 : 4));
  }
}

// A single run has no interval.
function spreadOf(point) {
  const interval = isNumber(metric.low[point]) ? ` (95 % ${compact(metric.low[point])} to ${withUnit(metric.high[point])})` : "";
  const runs = POINTS[point].runs;
  return `${interval}, ${runs} ${runs === 1 ? "run" : "runs"}`;
}

function heatKeyNote(best) {
  const bars = best.some((b) => b && isNumber(b.low) && b.low !== b.high);
  return `${best.some(Boolean) ? ` Red: the best ${AXES[heat.y].key} of each column${bars ? ", the bar its 95 % interval" : ""}.` : ""} Colours by rank, yellow is ${metric.better === "neither" ? "more" : "better"}.`;
}

function sayCell(cells, best) {
  const [c, r] = heat.cell;
  const cell = cells[c]?.[r];
  const place = `${AXES[heat.x].key} ${HEAT_AXES[heat.x].labels[c]}, ${AXES[heat.y].key} ${HEAT_AXES[heat.y].labels[r]}: `;
  const value = !cell ? "no result" : cell.count > 1 ? `${withUnit(cell.mean)}, mean of ${cell.count} points` : `${withUnit(cell.mean)}${spreadOf(cell.point)}`;
  const any = anyOf(heat.held, freeAxes([heat.x, heat.y])).length ? ` Means${heldTitle(heat.held, freeAxes([heat.x, heat.y]))}.` : "";
  const line = best[c] ? ` Best there: ${HEAT_AXES[heat.y].labels[best[c].row]}.` : "";
  byId("heat-note").textContent = `${place}${value}.${line}${any}${heatKeyNote(best)}`;
}

function heatButtons(cells, best, free) {
  const rows = () => HEAT_AXES[heat.y].labels.map((label, r) => [label, ...cells.map((column) => column[r]?.mean)]);
  return saveButtons(heatTitle(metric.label), {
    ...pictureKinds(() => heatSvg(cells, best, free)),
    CSV: () => csvText([[`${metricLabel()}: ${AXES[heat.y].key} down, ${AXES[heat.x].key} across${heldTitle(heat.held, free)}`, ...HEAT_AXES[heat.x].labels], ...rows()]),
  });
}

function drawHeat() {
  const axes = heatAxes();
  const free = freeAxes([heat.x, heat.y]);
  const names = axes.map((i) => [i, AXES[i].key]);
  const swap = (mine, other) => (value) => {
    if (heat[other] === Number(value)) heat[other] = heat[mine];
    heat[mine] = Number(value);
    heat.cell = [0, 0];
    drawHeat();
  };
  keepFocus(byId("heat-controls"), [select("Across", "heat-x", names, heat.x, swap("x", "y")), select("Up", "heat-y", names, heat.y, swap("y", "x")), ...holders("heat", heat.held, free, drawHeat)]);
  const cells = heatCells(free);
  const best = bestOfColumns(cells);
  if (!cells.flat().some(Boolean)) { byId("heat").replaceChildren(); byId("heat-note").textContent = "No run has these values together."; return; }
  const hadFocus = byId("heat").contains(document.activeElement);
  const canvas = heatPicture(cells, best, widthFor(byId("heat"), 320, 1000));
  canvas.tabIndex = 0;
  const choose = (c, r) => {
    heat.cell = [Math.max(0, Math.min(cells.length - 1, c)), Math.max(0, Math.min(cells[0].length - 1, r))];
    canvas.redraw();
    sayCell(cells, best);
  };
  canvas.addEventListener("pointermove", (event) => {
    const [c, r] = canvas.cellAt(event.offsetX, event.offsetY);
    if (c >= 0 && r >= 0 && c < cells.length && r < cells[0].length) choose(c, r);
  });
  canvas.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!step) return;
    event.preventDefault();
    choose(heat.cell[0] + step[0], heat.cell[1] + step[1]);
  });
  byId("heat").replaceChildren(canvas);
  byId("heat-controls").append(heatButtons(cells, best, free));
  if (hadFocus) canvas.focus();
  sayCell(cells, best);
}
