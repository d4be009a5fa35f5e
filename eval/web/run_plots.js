// Plots of a run over time, and the time of each stage.
"use strict";

// null if there is nothing to draw.
const scaled = (values, factor) => values.map((v) => (v === null ? null : v * factor));
const hasColumn = (column) => Boolean(frames[column]) && frames[column].some((v) => v !== null);
const times = frames.stamp_s.map((t) => t - frames.stamp_s[0]);

function addPlot(container, title, yLabel, series, more = {}) {
  if (!series.length || frameCount < 2) return;
  drawPlot(container, { title, x: times, xLabel: "time (s)", yLabel, series, sync: "frames", onCursor: selectFrame, ...more });
}

function initPlots() {
  if (frameCount < 2) {
    byId("plots").append(make("p", {}, "There is only one frame: the values beside the map are all there is."));
    byId("plots-how").remove();
    return;
  }
  const add = (title, yLabel, series, more) => addPlot(byId("plots"), title, yLabel, series, more);
  const column = (label, name, tone, factor, digits, unit) => ({ label, values: scaled(frames[name], factor), colour: tone, digits, unit });
  const degree = 180 / Math.PI;
  const gainsShown = [-1, 2];  // before a wall at a slant single entries of K are far outside 0 to 1 and would flatten all others
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
    add("Gain: diagonal of K, the share of each axis's own innovation that is taken", "share", [
      column("forward", "gain_forward", "est", 1, 3),
      column("left", "gain_left", "slam", 1, 3),
      column("yaw", "gain_yaw", "truth", 1, 3),
    ].map((s, k) => ({ ...s, width: [4.2, 2.9, 1.6][k] })), { withinY: gainsShown });  // those beneath show on both sides where axes have one gain
  }
  if (hasColumn("match_score")) add("Match score: share of the beams that the map explains", "share", [column("score", "match_score", "est", 1, 3)]);
  if (hasColumn("beams")) add("Beams with a hit", "beams", [{ ...column("beams", "beams", "est", 1, 0), values: whereMapped(frames.beams) }]);
}

// ---- stage times: timing.js, beside this page, so that the page is the same bytes every time ----
const STAGES = [["scan", RUN.input_poses === "odometry" ? "scan" : "depth to scan", "slam"], ["match", "match", "est"], ["fuse", "fuse", "truth"], ["insert", "insert", "invented"], ["loops", "loops", "missed"], ["rest", "rest", "online"]];
const LEAST_US = 1;  // shown: a stage that had nothing to do takes a fraction of it
// Of at least 25 frames each, at most 200 of them.
const BLOCK_FRAMES = Math.max(25, Math.ceil(frameCount / 200));

// The usual time of a frame, robust to rare frames that take far longer: the median of each block.
function mediansOfBlocks(values) {
  const blocks = Math.ceil(values.length / BLOCK_FRAMES);
  const medians = Array.from({ length: blocks }, (_, k) => median(values.slice(k * BLOCK_FRAMES, (k + 1) * BLOCK_FRAMES)));
  return values.map((v, i) => medians[Math.floor(i / BLOCK_FRAMES)]);
}

function initTimes() {
  const measured = window.RUN_TIMES;
  if (measured?.total_us.length !== frameCount) {
    byId("times").append(make("p", { class: "muted" }, measured
      ? "timing.js beside this page is another run's: copy this run's to see the stage times."
      : "timing.js does not lie beside this page: copy it along to see the stage times."));
    return;
  }
  const ordered = (values) => [...values].sort((a, b) => a - b);
  const at = (values, share) => values[Math.min(values.length - 1, Math.floor(share * values.length))];
  const row = (label, values) => {
    const sorted = ordered(whereMapped(values).filter(isNumber));
    const sum = values.reduce((a, b) => a + b, 0);
    const mean = sorted.reduce((a, b) => a + b, 0) / Math.max(1, sorted.length);
    return [label, fixed(mean, 0), fixed(at(sorted, 0.5), 0), fixed(at(sorted, 0.95), 0), fixed(at(sorted, 1), 0), fixed(sum / 1e6, 2)];
  };
  const shown = STAGES.filter(([name]) => measured[`${name}_us`]?.some((v) => v > 0));  // older runs lack some
  const lost = times.filter((t, i) => !hasPose(i)).length;
  if (lost) byId("times").append(make("p", { class: "muted" }, `Without the ${lost} ${lost === 1 ? "frame" : "frames"} that have no pose and are not mapped; the sums are of all.`));
  byId("times").append(make("div", { class: "scroll" }, tableOf(
    ["CPU time per frame", "mean µs", "median µs", "95 % µs", "longest µs", "sum s"],
    [...shown.map(([name, label]) => row(label, measured[`${name}_us`])), row("whole frame", measured.total_us)])));
  // The last stages are those that often have nothing to do and then lie at the bottom: the others over them.
  const lines = [...shown].reverse().map(([name, label, tone]) => ({ label, values: whereMapped(measured[`${name}_us`]), colour: tone, digits: 1, unit: "µs" }));
  if (frameCount >= 4 * BLOCK_FRAMES) {
    lines.push({ label: `whole frame, median of ${BLOCK_FRAMES}`, values: mediansOfBlocks(whereMapped(measured.total_us)), colour: "ink", digits: 1, unit: "µs", width: 2.4 });
  }
  addPlot(byId("times"), "CPU time of each stage", "µs", lines, { logY: true, leastY: LEAST_US, height: 260 });
}
