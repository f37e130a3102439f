'use strict';
/* Scales, axes, and the box that follows the pointer. */

const linearSteps = [1, 2, 5, 10];

function niceStep(span, count) {
  const step = span / count, power = 10 ** Math.floor(Math.log10(step));
  return power * linearSteps.find(s => s * power >= step * 0.999);
}

function linearTicks(low, high, count) {
  const step = niceStep(high - low, count), ticks = [];
  for (let i = Math.ceil(low / step - 1e-6); i * step <= high + step * 1e-6; i++)
    ticks.push(i * step);
  return ticks;
}

/** Powers of ten or two, with multiples by 2 and 5 where there is room. */
function logTicks(low, high, count, radix) {
  const ticks = [], every = radix === 2 ? [1] : [1, 2, 5];
  for (let k = Math.floor(Math.log(low) / Math.log(radix)); radix ** k <= high * 1.001; k++)
    ticks.push(...every.map(m => m * radix ** k).filter(t => t >= low * 0.999 && t <= high * 1.001));
  let kept = ticks.length > count + 1 && radix === 10 ? ticks.filter(t => Math.abs(Math.log10(t) % 1) < 1e-9) : ticks;
  if (kept.length < 2)
    kept = ticks;
  const stride = Math.ceil(kept.length / (count + 1));
  return kept.filter((tick, i) => i % stride === 0);
}

/**
 * Maps values to pixels from..to. Infinity has its own place at the end; NaN has none. The scale is
 * logarithmic if all values are positive and their ratio exceeds `logFrom`.
 */
function makeScale(values, unit, from, to, {count = 5, logFrom = 30, zero = false} = {}) {
  const finite = values.filter(Number.isFinite);
  const infinite = values.includes(Infinity);
  const end = infinite ? to - Math.sign(to - from) * 26 : to;
  let low = Math.min(...finite), high = Math.max(...finite);
  if (finite.length === 0)
    [low, high] = [0, 1];
  const log = low > 0 && high / low > logFrom;
  if (zero && !log && low > 0)
    low = 0;
  if (low === high)
    [low, high] = low === 0 ? [0, 1] : [low - Math.abs(low) * 0.1, high + Math.abs(high) * 0.1];
  const pad = log ? (high / low) ** 0.06 : (high - low) * 0.06;
  const startsAtZero = !log && low >= 0 && low - pad < 0;
  [low, high] = log ? [low / pad, high * pad] : [startsAtZero || (zero && low === 0) ? Math.min(low, 0) : low - pad, high + pad];
  const [divisor, shown] = scaleOf(unit, high);
  const map = log ? v => from + Math.log(v / low) / Math.log(high / low) * (end - from)
    : v => from + (v - low) / (high - low) * (end - from);
  const place = v => v === Infinity ? to - Math.sign(to - from) * 8 : map(Math.min(Math.max(v, low), high));
  const ticks = (log ? logTicks(low / divisor, high / divisor, count, unit === 'bytes' ? 2 : 10)
    : linearTicks(low / divisor, high / divisor, count)).map(t => ({at: map(t * divisor), text: digits(t, 4)}));
  if (infinite)
    ticks.push({at: place(Infinity), text: infinitySign});
  return {place, ticks, unit: shown, log, low, high};
}

function drawXAxis(scale, box, title) {
  const nodes = scale.ticks.map(tick => svg('g', {},
    svg('line', {class: 'grid', x1: tick.at, x2: tick.at, y1: box.top, y2: box.bottom}),
    svg('text', {x: tick.at, y: box.bottom + 16, 'text-anchor': 'middle'}, tick.text)));
  const text = title && svg('text', {class: 'title', x: box.right, y: box.bottom + 33, 'text-anchor': 'end'}, title);
  return svg('g', {'aria-hidden': 'true'}, nodes, svg('line', {class: 'axis', x1: box.left, x2: box.right, y1: box.bottom, y2: box.bottom}), text);
}

function drawYAxis(scale, box, title) {
  const nodes = scale.ticks.map(tick => svg('g', {},
    svg('line', {class: 'grid', x1: box.left, x2: box.right, y1: tick.at, y2: tick.at}),
    svg('text', {x: box.left - 7, y: tick.at + 4, 'text-anchor': 'end'}, tick.text)));
  const text = title && svg('text', {class: 'title', x: 0, y: 12}, title);
  return svg('g', {'aria-hidden': 'true'}, nodes, text);
}

/** Makes a title like "resident bytes peak, MiB, logarithmic". */
function axisTitle(name, scale) {
  return [name, scale.unit, scale.log ? 'logarithmic' : ''].filter(Boolean).join(', ');
}

/** Extent of the means and their intervals. Limits the intervals, which are huge with few
 * repeats. */
function extentOf(estimates) {
  const means = estimates.map(e => e.mean).filter(v => !Number.isNaN(v)), finite = means.filter(Number.isFinite);
  const low = Math.min(...finite), high = Math.max(...finite), room = (high - low) * 0.2 || Math.abs(high) * 0.1;
  const least = low > 0 ? Math.max(low - room, low * 0.7) : low - room;
  const ends = estimates.filter(e => e.half > 0 && Number.isFinite(e.mean)).flatMap(e => [e.mean - e.half, e.mean + e.half]);
  return [...means, ...ends.map(v => Math.min(Math.max(v, least), high + room))];
}

/** Makes an empty picture as wide as its place. */
function canvas(place, height, label) {
  const width = Math.max(Math.round(place.clientWidth - parseFloat(getComputedStyle(place).paddingLeft || 0) * 2), 160);
  return {width, height, root: svg('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': label})};
}

function path(points) {
  let text = '', drawing = false;
  for (const [x, y] of points) {
    if (Number.isNaN(y) || Number.isNaN(x)) {
      drawing = false;
      continue;
    }
    text += `${drawing ? 'L' : 'M'}${x.toFixed(1)} ${y.toFixed(1)}`;
    drawing = true;
  }
  return text;
}

/** Shows lines of text at a place on the screen. The first line is the heading. */
function showTip(x, y, lines) {
  const tip = byId('tip');
  tip.replaceChildren(html('b', {}, lines[0]), ...lines.slice(1).map(line => html('div', {}, line)));
  tip.hidden = false;
  const size = tip.getBoundingClientRect();
  const left = x + 14 + size.width > window.innerWidth ? x - 14 - size.width : x + 14;
  tip.style.left = `${Math.max(4, left)}px`;
  tip.style.top = `${Math.max(4, Math.min(y + 14, window.innerHeight - size.height - 4))}px`;
}

function hideTip() {
  byId('tip').hidden = true;
}

/** Functions that draw again when the page's width changes. Prints have their own width. */
const redraws = [];
function onResize(draw) {
  redraws.push(draw);
}
let lastWidth = window.innerWidth;
window.addEventListener('resize', () => {
  if (window.innerWidth === lastWidth)
    return;
  lastWidth = window.innerWidth;
  redraws.forEach(draw => draw());
});
window.addEventListener('scroll', hideTip, {passive: true});
