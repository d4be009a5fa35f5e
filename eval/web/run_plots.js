// What a run did over time, and how long each stage took.
"use strict";

// null where there is nothing to draw.
const scaled = (values, factor) => values.map((v) => (v === null ? null : v * factor));
const hasColumn = (column) => Boolean(frames[column]) && frames[column].some((v) => v !== null);
const times = frames.stamp_s.map((t) => t - frames.stamp_s[0]);

function addPlot(container, title, yLabel, series) {
  if (!series.length || frameCount < 2) return;
  drawPlot(container, { title, x: times, xLabel: "time (s)", yLabel, series, sync: "frames", onCursor: selectFrame });
}

function initPlots() {
  if (frameCount < 2) {
    byId("plots").append(make("p", {}, "There is one frame: the values at the map are all there is."));
    byId("plots-how").remove();
    return;
  }
  const add = (title, yLabel, series) => addPlot(byId("plots"), title, yLabel, series);
  const column = (label, name, tone, factor, digits, unit) => ({ label, values: scaled(frames[name], factor), colour: tone, digits, unit });
  const degree = 180 / Math.PI;
  if (hasColumn("slam_error_m")) {
    add("Distance from the truth, in the plane", "cm", [
      column("SLAM", "slam_error_m", "slam", 100, 2, "cm"),
      column("estimate at the time", "map_error_m", "online", 100, 2, "cm"),
      column("estimate at the end", "est_error_m", "est", 100, 2, "cm"),
    ]);
  }
  if (hasColumn("innovation_forward_m")) {
    add("Innovation: match against prediction", "cm", [
      column("forward", "innovation_forward_m", "est", 100, 2, "cm"),
      column("left", "innovation_left_m", "slam", 100, 2, "cm"),
    ]);
    add("Innovation in heading", "degrees", [column("yaw", "innovation_yaw_rad", "truth", degree, 3, "°")]);
    add("Gain: diagonal of K, of the innovation taken in each axis by itself", "share", [
      column("forward", "gain_forward", "est", 1, 3),
      column("left", "gain_left", "slam", 1, 3),
      column("yaw", "gain_yaw", "truth", 1, 3),
    ].map((s, k) => ({ ...s, width: [4.2, 2.9, 1.6][k] })));  // those beneath show on both sides where axes have one gain
  }
  if (hasColumn("match_score")) add("Match score: share of the beams that the map explains", "share", [column("score", "match_score", "est", 1, 3)]);
  if (hasColumn("beams")) add("Beams with a hit", "beams", [{ ...column("beams", "beams", "est", 1, 0), values: whereMapped(frames.beams) }]);
}

// ---- stage times: timing.js, beside this page, so that the page is the same bytes every time ----
const STAGES = [["scan", "depth to scan", "slam"], ["match", "match", "est"], ["fuse", "fuse", "truth"], ["insert", "insert", "invented"], ["loops", "loops", "missed"]];

function initTimes() {
  const measured = window.RUN_TIMES;
  if (!measured) {
    byId("times").append(make("p", { class: "muted" }, "timing.js does not lie beside this page: copy it along to see the stage times."));
    return;
  }
  if (measured.total_us.length !== frameCount) return;
  const ordered = (values) => [...values].sort((a, b) => a - b);
  const at = (values, share) => values[Math.min(values.length - 1, Math.floor(share * values.length))];
  const row = (label, values) => {
    const sorted = ordered(whereMapped(values).filter(isNumber));
    const sum = values.reduce((a, b) => a + b, 0);
    return [label, fixed(at(sorted, 0.5), 0), fixed(at(sorted, 0.95), 0), fixed(at(sorted, 1), 0), fixed(sum / 1e6, 2)];
  };
  const shown = STAGES.filter(([name]) => measured[`${name}_us`].some((v) => v > 0));
  const lost = times.filter((t, i) => !hasPose(i)).length;
  if (lost) byId("times").append(make("p", { class: "muted" }, `Without the ${lost} ${lost === 1 ? "frame" : "frames"} that have no pose and are not mapped; the sums are of all.`));
  byId("times").append(make("div", { class: "scroll" }, tableOf(
    ["CPU time a frame", "median µs", "95 % µs", "longest µs", "sum s"],
    [...shown.map(([name, label]) => row(label, measured[`${name}_us`])), row("whole frame", measured.total_us)])));
  addPlot(byId("times"), "CPU time of each stage", "ms", shown.map(([name, label, tone]) =>
    ({ label, values: scaled(whereMapped(measured[`${name}_us`]), 1e-3), colour: tone, digits: 3, unit: "ms" })));
}
