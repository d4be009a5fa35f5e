// The page of a study: cases side by side, with published figures.
"use strict";
const STUDY = JSON.parse(byId("data").textContent);
const NAMES = { ground_truth: "Ground truth", orb_slam2: "ORB-SLAM2", planar_slam: "Planar-SLAM", planar_slam_mh: "Planar-SLAM, Manhattan" };
// A readable name; paths of files are unchanged.
const nameOf = (word) => NAMES[word] ?? (word.includes("/") ? word : word.charAt(0).toUpperCase() + word.slice(1).replaceAll("_", " "));
const casesIn = (room) => STUDY.cases.filter((c) => c.scene === room.scene);
// The maps are light in both themes, so what is drawn on them keeps its colours.
const PATH_COLOURS = { truth: "#009e73", input: "#d98c00", output: "#0072b2" };
// Named by the source of its poses, and by its own name where several cases of a room share the source.
const isAlone = (c) => STUDY.cases.filter((one) => one.scene === c.scene && one.pose_source === c.pose_source).length === 1;
const sourceOf = (c) => (isAlone(c) ? nameOf(c.pose_source) : `${nameOf(c.pose_source)} (${c.name})`);
const millimetres = (value) => fixed(isNumber(value) ? 1000 * value : value, 1);
const seen = (map) => map?.observable ?? map?.all;

// Without and with alignment; the best errors are a few millimetres.
const errorCells = (score) => [fixed(score?.mean_euclidean_m, 4), fixed(score?.ate_rmse_se2_m, 4)];
const linkTo = (c, text) => make("a", { href: linkOf(`${STUDY.back}${c.name}/report.html`) }, text);

// Header rows: rooms, then what the errors are of, then how they are computed.
function tableHead() {
  const group = (text, columns, first) => make("th", { scope: columns > 1 ? "colgroup" : "col", colspan: columns, class: first ? "room" : "" }, text);
  const rooms = STUDY.rooms.map((room) => group(nameOf(room.scene), 5, true));
  const what = STUDY.rooms.flatMap(() => [group(STUDY.headings.published, 1, true), group("input", 2), group("output", 2)]);
  const how = STUDY.rooms.flatMap(() => ["mean", "mean", "aligned", "mean", "aligned"].map((text, i) => group(text, 1, i === 0)));
  const source = make("th", { scope: "col", rowspan: 3 }, "Poses from");
  return make("thead", {}, make("tr", {}, source, ...rooms), make("tr", {}, ...what), make("tr", {}, ...how));
}

function initTable() {
  const sources = [...new Set(STUDY.cases.map(sourceOf))];
  const rows = sources.map((source) => [source, ...STUDY.rooms.flatMap((room) => {
    const c = casesIn(room).find((one) => sourceOf(one) === source);
    if (!c) return Array(5).fill("–");
    const output = errorCells(c.metrics.trajectory.est).map((text) => linkTo(c, text));
    return [fixed(c.metrics.published_mean_m, 3), ...errorCells(c.metrics.trajectory.slam), ...output];
  })]);
  const table = tableOf([], rows);
  table.tHead.replaceWith(tableHead());
  for (const row of table.tBodies[0].rows) [...row.cells].forEach((cell, i) => cell.classList.toggle("room", i % 5 === 1));
  byId("table").append(table);
  byId("table-title").append(saveButtons(STUDY.headings.table, { CSV: () => csvOfTable(table, "m") }));
  byId("subtitle").textContent = `${STUDY.cases.length} cases, ${STUDY.rooms.map((room) => nameOf(room.scene)).join(" and ")}`;
}

// A strip of its own, so that the scale bar hides no wall; metres, from y down.
const STRIP_M = 0.6;
function scaleBar(room, y) {
  return [svg("rect", { class: "bar-back", x: 0, y, width: room.width * room.resolution, height: STRIP_M }),
    svg("line", { class: "bar", x1: 0.2, x2: 1.2, y1: y + 0.3, y2: y + 0.3 }),
    svg("text", { class: "bar-text", x: 1.35, y: y + 0.4 }, "1 m")];
}
function barPicture(room) {
  return svg("svg", { viewBox: `0 0 ${room.width * room.resolution} ${STRIP_M}`, role: "img", "aria-label": `${room.scene}: scale` }, ...scaleBar(room, 0));
}

function figure(source, label, caption, ...beneath) {
  const picture = source ? make("img", { src: source, alt: label }) : make("span", {}, "–");
  return make("figure", {}, picture, ...beneath, make("figcaption", {}, caption));
}

function initMaps() {
  for (const room of STUDY.rooms) {
    const cases = casesIn(room);
    const f1 = (map) => `F1 ${fixed(seen(map)?.occupied.f1, 3)}`;
    const row = (first, figures) => make("div", { class: "figure-row" }, first, ...figures);
    const rows = [
      row(figure(room.truth, `${room.scene}: true map`, "Truth, at the scale of all maps", barPicture(room)),
        cases.map((c) => figure(c.input_map, `${c.name}: map at input poses`, `${sourceOf(c)}, input: ${f1(c.metrics.input_map)}`))),
      row(make("figure", { class: "blank" }), cases.map((c) => figure(c.output_map, `${c.name}: output map`, make("span", {}, linkTo(c, `${sourceOf(c)}, output`), `: ${f1(c.metrics.map)}`))))];
    byId("maps").append(headWithSave("maps", room, rows), ...rows);
  }
}

// Metres, y up, drawn over the true map.
function pathPicture(room, c) {
  const width = room.width * room.resolution;
  const height = room.height * room.resolution;
  const line = (path, name) => {
    const points = [];
    for (let i = 0; i + 1 < path.length; i += 2) points.push(`${fixed(path[i] - room.origin[0], 3)},${fixed(height - (path[i + 1] - room.origin[1]), 3)}`);
    return svg("polyline", { points: points.join(" "), stroke: PATH_COLOURS[name], class: name });
  };
  const picture = svg("svg", { viewBox: `0 0 ${width} ${height + STRIP_M}`, role: "img", "aria-label": `${c.name}: trajectories` });
  if (room.truth) picture.append(svg("image", { href: room.truth, width, height, opacity: 0.55, preserveAspectRatio: "none" }));
  if (c.true_path) picture.append(line(c.true_path, "truth"));
  picture.append(line(c.input_path, "input"), line(c.output_path, "output"),
    ...scaleBar(room, height));
  return picture;
}

// Figures of the rows, one below the other, with their captions.
function rowsSvg(rows, names) {
  const [GAP, LINE] = [6, 13];
  const size = (one) => (one.naturalWidth ? [one.naturalWidth, one.naturalHeight] : (one.getAttribute("viewBox")?.split(" ") ?? [0, 0, 1, 1]).slice(2).map(Number));
  let y = 0;
  const parts = [];
  for (const row of rows) {
    const figures = [...row.children];
    const width = (FIGURE_WIDTH - GAP * (figures.length - 1)) / figures.length;
    const ends = figures.map((figure, k) => {
      let below = y;
      for (const one of figure.querySelectorAll(":scope > img, :scope > svg")) {
        const [w, h] = size(one);
        const place = { x: k * (width + GAP), y: below, width, height: (width * h) / w };
        parts.push(one.naturalWidth ? svg("image", { href: one.src, ...place, style: "image-rendering: pixelated" }) : inlined(one, place));
        below += place.height;
      }
      for (const line of wrapped(figure.querySelector("figcaption")?.textContent ?? "", width / 5)) {
        below += LINE;
        parts.push(svg("text", { x: k * (width + GAP), y: below - 2, "font-size": 9, fill: INK }, line));
      }
      return below;
    });
    y = Math.max(...ends) + GAP;
  }
  const legend = legendOf(names.map((name) => ({ label: name, stroke: PATH_COLOURS[name], ...(name === "truth" ? { width: 8, opacity: 0.5 } : {}) })), y);
  return figureSvg(y + (names.length ? legend.height : 0), ...parts, ...legend.elements);
}

// A picture of the page with the properties from its style sheet.
function inlined(picture, place) {
  const copy = picture.cloneNode(true);
  const styled = [...picture.querySelectorAll("*")];
  [...copy.querySelectorAll("*")].forEach((element, i) => {
    const style = getComputedStyle(styled[i]);
    for (const name of ["fill", "stroke", "stroke-width", "stroke-opacity", "font-size", "image-rendering"]) element.style.setProperty(name, style.getPropertyValue(name));
  });
  for (const [name, value] of Object.entries(place)) copy.setAttribute(name, value);
  return copy;
}
const headWithSave = (what, room, rows, names = []) => make("h3", {}, nameOf(room.scene), saveButtons(`${what} ${room.scene}`, pictureKinds(() => rowsSvg(rows, names))));

function initPaths() {
  for (const key of document.querySelectorAll(".paths-legend i")) key.style.background = PATH_COLOURS[key.dataset.path];
  for (const room of STUDY.rooms) {
    const row = make("div", { class: "figure-row four" }, ...casesIn(room).map((c) => make("figure", {}, pathPicture(room, c), make("figcaption", {}, sourceOf(c)))));
    byId("paths").append(headWithSave("trajectories", room, [row], Object.keys(PATH_COLOURS)), row);
  }
}

function initMapTable() {
  const values = (map) => {
    const s = seen(map);
    return s ? [s.occupied.precision, s.occupied.recall, s.occupied.f1].map((v) => fixed(v, 3)).concat(millimetres(s.chamfer_m)) : ["–", "–", "–", "–"];
  };
  const table = tableOf(
    ["Case", ...["input", "output"].flatMap((map) => ["precision", "recall", "F1", "chamfer (mm)"].map((score) => `${map} ${score}`))],
    STUDY.cases.map((c) => [linkTo(c, `${nameOf(c.scene)}, ${sourceOf(c)}`), ...values(c.metrics.input_map), ...values(c.metrics.map)]));
  byId("map-table").append(table);
  byId("map-table-title").append(saveButtons("Scores of the maps", { CSV: () => csvOfTable(table) }));
}

// Overrides from the command line: published figures and notes apply to the unchanged file.
function initOverrides() {
  if (STUDY.overrides.length === 0) { byId("overrides").remove(); return; }
  byId("overrides").append("Changed on the command line: ", ...STUDY.overrides.flatMap((text, i) => [i > 0 ? ", " : "", make("code", {}, text)]),
    ". Notes and published figures are those of the study as it is written.");
}

function initNotes() {
  if (STUDY.notes.length === 0) { byId("notes-section").hidden = true; return; }
  for (const note of STUDY.notes) byId("notes").append(make("dt", {}, note.title), make("dd", {}, note.text));
}

// "seed: 3 (orb), 1 (truth, moved)", of each setting that is not the same in all cases.
function initDifferences() {
  const seeds = STUDY.differences.some(({ key }) => key.endsWith("seed"));
  byId("seeds").textContent = seeds ? "One seed per case, not the same in all." : "One seed.";
  if (STUDY.differences.length === 0) { byId("differences").remove(); return; }
  const text = ({ key, values }) => [...new Set(values)].map((value) =>
    `${value} (${STUDY.cases.filter((_, i) => values[i] === value).map((c) => c.name).join(", ")})`).join(", ");
  byId("differences").append("Besides scene and SLAM, cases differ in ", ...STUDY.differences.flatMap((one, i) =>
    [i > 0 ? "; " : "", make("code", {}, one.key), `: ${text(one)}`]), ".");
}

function initHeadings() {
  for (const part of ["table", "maps", "paths", "notes"]) byId(`${part}-title`).textContent = STUDY.headings[part];
}

initTheme();
initHeadings();
initOverrides();
initDifferences();
initTable();
initMaps();
initPaths();
initMapTable();
initNotes();
document.documentElement.dataset.ready = "true";
