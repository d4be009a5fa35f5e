// As much of a canvas' context as the pages paint with, that gives the elements of an SVG: a figure on the screen and
// its file are painted by the same function.
"use strict";
class SvgContext {
  constructor() {
    this.parts = [];
    this.transform = "";
    this.kept = [];
  }
  add(tag, attributes, ...children) {
    this.parts.push(svg(tag, { ...attributes, ...(this.transform ? { transform: this.transform } : {}) }, ...children));
  }
  fillRect(x, y, width, height) { this.add("rect", { x, y, width, height, fill: this.fillStyle }); }
  strokeRect(x, y, width, height) { this.add("rect", { x, y, width, height, fill: "none", ...this.pen() }); }
  beginPath() { this.path = ""; }
  moveTo(x, y) { this.path += `M${x.toFixed(2)},${y.toFixed(2)}`; }
  lineTo(x, y) { this.path += `${this.path ? "L" : "M"}${x.toFixed(2)},${y.toFixed(2)}`; }
  // Always a full circle; the pages paint no other arcs.
  arc(x, y, radius) { this.path += `M${(x - radius).toFixed(2)},${y.toFixed(2)}a${radius},${radius} 0 1 0 ${2 * radius},0a${radius},${radius} 0 1 0 ${-2 * radius},0`; }
  stroke() { this.add("path", { d: this.path, fill: "none", ...this.pen() }); }
  fill() { this.add("path", { d: this.path, fill: this.fillStyle }); }
  fillText(text, x, y) { this.add("text", { x, y, ...this.letters(), fill: this.fillStyle }, text); }
  strokeText(text, x, y) { this.add("text", { x, y, ...this.letters(), fill: "none", ...this.pen() }, text); }
  save() { this.kept.push(this.transform); }
  restore() { this.transform = this.kept.pop(); }
  translate(x, y) { this.transform += `translate(${x},${y}) `; }
  rotate(angle) { this.transform += `rotate(${angle * 180 / Math.PI}) `; }
  pen() { return { stroke: this.strokeStyle, "stroke-width": this.lineWidth, "stroke-linejoin": "round" }; }
  letters() { return { "font-size": 11, "text-anchor": { center: "middle", right: "end" }[this.textAlign] ?? "start" }; }
}
