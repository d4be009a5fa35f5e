// Grid points and runs as tables that sort and filter.
"use strict";
const table = { what: "points", sort: 0, down: false, filters: [], most: 100 };

// What each table shows: {title, unit, numeric, at(row), text(row) where that is not at(row) in short}.
function columnsOf(what) {
  const runs = SWEEP.runs;
  const pointOf = what === "points" ? (row) => row : (row) => runs.point[row];
  const axes = AXES.map((axis, i) => ({
    title: axis.key, numeric: axis.numeric,
    at: (row) => { const k = POINTS[pointOf(row)].values[i]; return axis.numeric ? axis.numbers[k] : axis.texts[k]; },
    text: (row) => axis.labels[POINTS[pointOf(row)].values[i]],
  }));
  if (what === "points") {
    const shown = METRICS.filter((m) => m.main || m === metric);
    return [...axes, { title: "runs", numeric: true, at: (row) => POINTS[row].runs },
      ...shown.flatMap((m) => [
        { title: m.label, unit: m.unit, numeric: true, at: (row) => m.mean[row] },
        ...(m === metric ? [{ title: "95 % low", unit: m.unit, numeric: true, at: (row) => m.low[row] }, { title: "95 % high", unit: m.unit, numeric: true, at: (row) => m.high[row] },
          { title: "median", unit: m.unit, numeric: true, at: (row) => m.median[row] }] : [])])];
  }
  const shown = METRICS.filter((m) => runs.metrics?.[m.name]);
  return [{ title: "run", numeric: true, at: (row) => runs.run[row], text: (row) => String(runs.run[row]) },
    { title: "page", link: true, at: (row) => (runs.failures[row] ? "failed" : runs.folder[row] ? "open" : "command") }, ...axes,
    ...(SWEEP.seed_keys.length ? [{ title: SWEEP.seed_keys.join(" "), numeric: SWEEP.seed_keys.length === 1, at: (row) => (SWEEP.seed_keys.length === 1 ? Number(runs.seeds[row]) : runs.seeds[row]), text: (row) => runs.seeds[row] }] : []),
    ...shown.map((m) => ({
      title: m.label, unit: m.unit, numeric: true,
      at: (row) => (runs.metrics[m.name][row] === null ? null : runs.metrics[m.name][row] * m.factor),
    }))];
}

// The text of a cell.
const shownText = (column, row) => column.text?.(row) ?? (column.numeric ? compact(column.at(row)) : String(column.at(row) ?? "–"));

// "0.5", "<0.1", ">= 3", "0.2..0.4" for numbers, where a number is also found as it is shown; part of the text for texts,
// and for anything else. Gives what tests a value and its shown text.
function matcher(text, numeric) {
  const wanted = text.trim();
  if (!wanted) return () => true;
  const range = wanted.match(/^(-?[\d.eE+-]+)\s*\.\.\s*(-?[\d.eE+-]+)$/);
  const comparison = wanted.match(/^(<=|>=|<|>|=)?\s*(-?[\d.eE+-]+)$/);
  if (numeric && range) return (v) => isNumber(v) && v >= Number(range[1]) && v <= Number(range[2]);
  if (numeric && comparison) {
    const limit = Number(comparison[2]);
    const rule = { "<": (v) => v < limit, "<=": (v) => v <= limit, ">": (v) => v > limit, ">=": (v) => v >= limit, "=": (v, shown) => v === limit || shown === comparison[2] }[comparison[1] ?? "="];
    return (v, shown) => isNumber(v) && rule(v, shown);
  }
  return (v) => String(v ?? "").toLowerCase().includes(wanted.toLowerCase());
}

// The command that makes a run again, to be started in this folder.
function commandOf(row) {
  const runs = SWEEP.runs;
  const set = AXES.map((axis, i) => [axis.key, axis.set[POINTS[runs.point[row]].values[i]]]);
  runs.seeds[row].split(" ").forEach((seed, i) => { if (SWEEP.seed_keys[i]) set.push([SWEEP.seed_keys[i], seed]); });
  return `depthgrid run experiment.yaml ${set.map(([key, value]) => `--set ${key}=${value}`).join(" ")} -o runs/${runs.run[row]}`;
}

function linkCell(row, text) {
  if (text === "open") return make("a", { href: linkOf(`${SWEEP.back}${SWEEP.runs.folder[row]}/report.html`) }, "open");
  if (text === "failed") return make("span", { class: "failed", title: SWEEP.runs.failures[row] }, "failed");
  return make("button", { type: "button", class: "link", title: commandOf(row), "aria-label": `Command that makes run ${SWEEP.runs.run[row]} again`,
    onclick: () => {
      byId("table-command").textContent = commandOf(row);
      navigator.clipboard?.writeText(commandOf(row)).then(() => { byId("table-copied").textContent = "Copied. "; }, () => {});
    } }, "command");
}

function rowsShown(columns) {
  const count = table.what === "points" ? POINTS.length : SWEEP.runs.run.length;
  const filters = columns.map((column, k) => ({ column, text: table.filters[k] ?? "" })).filter(({ text }) => text.trim())
    .map(({ column, text }) => ({ column, test: matcher(text, column.numeric) }));
  const rows = [...Array(count).keys()].filter((row) => filters.every(({ column, test }) => test(column.at(row), shownText(column, row))));
  const { at, numeric } = columns[table.sort] ?? columns[0];
  const sign = table.down ? -1 : 1;
  // Missing values last, in either direction.
  return rows.sort((a, b) => {
    const [x, y] = [at(a), at(b)];
    if (x === null || y === null) return (x === null) - (y === null) || a - b;
    return sign * (numeric ? x - y : String(x).localeCompare(String(y))) || a - b;
  });
}

function drawRows(columns, body) {
  const rows = rowsShown(columns);
  body.replaceChildren(...rows.slice(0, table.most).map((row) => make("tr", {}, ...columns.map((column) => {
    return make("td", {}, column.link ? linkCell(row, column.at(row)) : shownText(column, row));
  }))));
  const heads = columns.map((column) => `${column.title}${column.unit ? ` (${column.unit})` : ""}`);
  const written = () => csvText([heads, ...rows.map((row) => columns.map((column) => (column.link ? commandOf(row) : column.numeric ? column.at(row) : column.text?.(row) ?? column.at(row))))]);
  const more = rows.length > table.most;
  const note = byId("table-note");
  note.replaceChildren(`${rows.length} ${rows.length === 1 ? "row" : "rows"}${more ? `, the first ${table.most} shown. ` : ". "}`);
  if (more) note.append(make("button", { type: "button", class: "no-print", onclick: () => { table.most *= 10; drawRows(columns, body); } }, "Show more"));
  note.append(saveButtons(`${SWEEP.environment.title ?? "sweep"} ${table.what}`, { CSV: written }));
  if (table.what === "runs") {
    note.append(make("br"), "Runs without a folder can be made again: start the command in this sweep's folder, then “open” it after ", make("code", {}, "depthgrid report ."), ".",
      make("br"), make("span", { id: "table-copied" }), make("code", { id: "table-command" }));
  }
}

function drawTable() {
  const columns = columnsOf(table.what);
  const body = make("tbody");
  const sortBy = (k) => { table.down = table.sort === k && !table.down; table.sort = k; drawTable(); byId("table").querySelectorAll("th button")[k].focus(); };
  const heads = columns.map((column, k) => make("th", { scope: "col", "aria-sort": table.sort !== k ? "none" : table.down ? "descending" : "ascending" },
    make("button", { type: "button", class: "sort", onclick: () => sortBy(k) }, `${column.title.replaceAll(/[._]/g, "$&\u200b")}${column.unit ? ` (${column.unit})` : ""} ${table.sort === k ? (table.down ? "▼" : "▲") : ""}`)));
  const filters = columns.map((column, k) => {
    const input = make("input", { type: "search", size: "8", placeholder: column.numeric ? "<1" : "filter", "aria-label": `Filter ${column.title}` });
    input.value = table.filters[k] ?? "";
    input.addEventListener("input", () => { table.filters[k] = input.value; drawRows(columns, body); });
    return make("th", { class: "no-print" }, input);
  });
  byId("table").replaceChildren(make("table", { class: "grid" }, make("thead", {}, make("tr", {}, ...heads), make("tr", {}, ...filters)), body));
  drawRows(columns, body);
}

function initTable() {
  const choose = (value) => { Object.assign(table, { what: value, sort: 0, down: false, filters: [], most: 100 }); drawTable(); };
  const options = [["points", "grid points (means over seeds)"], ...(SWEEP.runs ? [["runs", "single runs"]] : [])];
  byId("table-controls").append(select("Show", "table-what", options, "points", choose),
    make("span", { class: "muted no-print" }, "Filters: part of a text; for numbers also <0.1, >=3, 0.2..0.4."));
  changed.push(() => { table.filters = []; drawTable(); });
  drawTable();
}
