'use strict';
/* Pareto fronts: two figures against each other, what is best in both along stairs. */

/** -1 where more is better, so that less of the product is. */
function costSign(metric) {
  return sweep.metrics[metric].better === 'more' ? -1 : 1;
}

/** Indices of the points than which none is better in both, by the cost in x. */
function frontOf(x, y) {
  if (sweep.metrics[x].better === 'neither' || sweep.metrics[y].better === 'neither')
    return [];
  const sx = costSign(x), sy = costSign(y);
  const cost = done.map(i => ({i, a: sx * estimate(i, x).mean, b: sy * estimate(i, y).mean}))
    .filter(c => !Number.isNaN(c.a) && !Number.isNaN(c.b)).sort((p, q) => p.a - q.a || p.b - q.b);
  const front = [];
  let best = Infinity;
  for (const c of cost) {
    if (c.b < best || front.length === 0) {
      front.push(c.i);
      best = c.b;
    }
  }
  return front;
}

const pairs = [['resident_bytes_peak', 'flip_mean'], ['gpu_ms_median', 'psnr_mean_db'], ['time', 'flip_mean'], ['bytes_read', 'flip_mean'],
  ['resident_bytes_peak', 'levels_too_coarse'], ['loaded_bytes', 'levels_too_coarse'], ['resident_bytes_peak', 'frames_until_sharp_p99'],
  ['resident_bytes_peak', 'psnr_lowest_db'], ['core_us_per_frame', 'levels_too_coarse'], ['resident_bytes_peak', 'loaded_per_needed'],
  ['frame_ms_median', 'psnr_mean_db'], ['resident_bytes_peak', 'missing_pixels_percent'], ['resident_bytes_peak', 'gpu_ms_median']];

/** Pairs of metrics that are there; whatever there is, if none of the usual ones. */
function usualPairs() {
  const there = pairs.map(pair => pair.map(findMetric)).filter(pair => pair[0] >= 0 && pair[1] >= 0);
  const found = there.filter(pair => done.length < 2 || !pair.some(isConstant)).slice(0, 4);
  return found.length > 0 || known.length < 2 ? found : [[known[0], known[1]]];
}

const front = {x: -1, y: -1, shown: null};

function barNodes(e, scale, draw) {
  if (!(e.half > 0) || !Number.isFinite(e.mean))
    return null;
  return draw(scale.place(e.mean - e.half), scale.place(e.mean + e.half));
}

function drawBars(index, at, scales, metrics) {
  const attributes = {class: hushed(index) ? 'bar hushed' : 'bar', stroke: groupColor(groupOf(index))};
  return [
    barNodes(estimate(index, metrics[0]), scales[0], (a, b) => svg('line', {...attributes, x1: a, x2: b, y1: at[1], y2: at[1]})),
    barNodes(estimate(index, metrics[1]), scales[1], (a, b) => svg('line', {...attributes, x1: at[0], x2: at[0], y1: a, y2: b}))];
}

function hushed(index) {
  return front.shown !== null && groupOf(index) !== front.shown;
}

/** Stairs through the front, and the area beyond them in which no run is. */
function drawStairs(indices, place, box, metrics) {
  if (indices.length === 0)
    return [];
  const worstX = costSign(metrics[0]) > 0 ? box.right : box.left, bestX = costSign(metrics[0]) > 0 ? box.left : box.right;
  const worstY = costSign(metrics[1]) > 0 ? box.top : box.bottom, bestY = costSign(metrics[1]) > 0 ? box.bottom : box.top;
  const corners = indices.map(place), stairs = [[corners[0][0], worstY], corners[0]];
  for (let k = 1; k < corners.length; k++)
    stairs.push([corners[k][0], corners[k - 1][1]], corners[k]);
  stairs.push([worstX, corners[corners.length - 1][1]]);
  const beyond = [...stairs, [worstX, bestY], [bestX, bestY], [bestX, worstY]];
  return [svg('path', {class: 'beyond', d: path(beyond) + 'Z'}), svg('path', {class: 'stairs', d: path(stairs)})];
}

function betterText(metrics, box) {
  if (metrics.some(m => sweep.metrics[m].better === 'neither'))
    return null;
  const right = costSign(metrics[0]) < 0, up = costSign(metrics[1]) < 0;
  return svg('text', {x: right ? box.right - 6 : box.left + 8, y: up ? box.top + 16 : box.bottom - 8, 'text-anchor': right ? 'end' : 'start'},
    right ? (up ? 'better \u2197' : 'better \u2198') : (up ? '\u2196 better' : '\u2199 better'));
}

/** Names of what is recommended, above or below its mark, away from the edges. */
function drawNames(indices, place, box) {
  const used = [];
  return indices.filter(i => roles(i).length > 0).map(i => {
    const [x, y] = place(i), text = roles(i).join(', ').slice(0, 40);
    const start = x < box.left + (box.right - box.left) * 0.62;
    let at = y - 10 < box.top + 12 ? y + 20 : y - 10;
    while (used.some(u => Math.abs(u[0] - x) < 130 && Math.abs(u[1] - at) < 14))
      at += at > y ? 14 : at - 14 > box.top ? -14 : y + 20 - at;
    used.push([x, at]);
    return svg('text', {class: 'name', x: start ? x + 7 : x - 7, y: at, 'text-anchor': start ? 'start' : 'end'}, text);
  });
}

function tipLines(index, metrics) {
  return [pointName(index), ...[...new Set([...metrics, ...tellingMetrics(4)])].map(m => `${metricName(m)}: ${estimateText(index, m)}`)];
}

/** Draws a mark, with the listeners that make it interactive. */
function drawMark(index, at, radius, onFront, metrics) {
  const group = groupOf(index);
  const classes = ['mark', onFront ? 'best' : 'behind', hushed(index) ? 'hushed' : ''].join(' ');
  return svg('path', {class: classes, d: groupShape(group, onFront ? radius : radius * 0.85), fill: groupColor(group),
    transform: `translate(${at[0].toFixed(1)} ${at[1].toFixed(1)})`, 'data-point': index,
    onclick: () => choose(index), onpointerleave: hideTip,
    onpointerenter: event => showTip(event.clientX, event.clientY, tipLines(index, metrics))});
}

/** Arrow keys go through the marks from left to right, Enter chooses. */
function addKeys(root, order, place, metrics) {
  let current = -1;
  root.setAttribute('tabindex', '0');
  root.addEventListener('keydown', event => {
    const step = {ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1}[event.key];
    if (event.key === 'Enter' && current >= 0)
      choose(order[current]);
    if (!step || order.length === 0)
      return;
    event.preventDefault();
    current = current < 0 ? Math.max(order.indexOf(chosen), 0) : (current + step + order.length) % order.length;
    const [x, y] = place(order[current]), area = root.getBoundingClientRect(), scale = area.width / root.viewBox.baseVal.width;
    showTip(area.left + x * scale, area.top + y * scale, tipLines(order[current], metrics));
    say(tipLines(order[current], metrics).join(', '));
  });
  root.addEventListener('blur', hideTip);
}

/** Draws a front into its place, which is emptied; large ones have names and keys. */
function drawFront(holder, metrics, height, large) {
  holder.replaceChildren();
  const [mx, my] = metrics, shown = done.filter(i => metrics.every(m => !Number.isNaN(estimate(i, m).mean)));
  const label = `${metricName(my)} against ${metricName(mx)}, ${shown.length} runs`;
  const {width, root} = canvas(holder, height, label);
  const box = {left: large ? 56 : 46, right: width - 12, top: 24, bottom: height - 40};
  const extent = m => extentOf(shown.map(i => large ? estimate(i, m) : {mean: estimate(i, m).mean, half: NaN}));
  const scales = [makeScale(extent(mx), sweep.metrics[mx].unit, box.left, box.right, {count: width < 380 ? 3 : 6}),
    makeScale(extent(my), sweep.metrics[my].unit, box.bottom, box.top, {count: large ? 6 : 4})];
  const place = i => [scales[0].place(estimate(i, mx).mean), scales[1].place(estimate(i, my).mean)];
  const best = frontOf(mx, my), radius = large ? 6.5 : 4.5;
  const order = [...shown].sort((a, b) => place(a)[0] - place(b)[0]);
  const behindFirst = [...shown].sort((a, b) => best.includes(a) - best.includes(b));
  root.append(drawXAxis(scales[0], box, axisTitle(large ? metricName(mx) : '', scales[0])), drawYAxis(scales[1], box, axisTitle(large ? metricName(my) : '', scales[1])),
    ...drawStairs(best, place, box, metrics), ...[large ? betterText(metrics, box) : null].filter(Boolean),
    ...(large ? shown.flatMap(i => drawBars(i, place(i), scales, metrics)).filter(Boolean) : []),
    ...behindFirst.map(i => drawMark(i, place(i), radius, best.includes(i), metrics)));
  for (const [index, kind] of [[base, 'ring base'], [chosen, 'ring']])
    if (shown.includes(index))
      root.append(svg('circle', {class: kind, r: radius + (kind === 'ring' ? 5 : 3), cx: place(index)[0], cy: place(index)[1]}));
  if (large) {
    root.append(...drawNames(shown, place, box));
    addKeys(root, order, place, metrics);
  }
  holder.append(root);
  return best;
}

function drawLegend() {
  const groups = ['base', ...varied, ...(done.some(i => groupOf(i) === 'several') ? ['several'] : [])];
  byId('legend').replaceChildren(...groups.map(group => html('button', {type: 'button', 'aria-pressed': String(front.shown === group),
    onclick: () => { front.shown = front.shown === group ? null : group; drawFronts(); }},
  svg('svg', {viewBox: '-8 -8 16 16', 'aria-hidden': 'true'}, svg('path', {d: groupShape(group, 5.5), fill: groupColor(group)})), groupName(group))));
}

function drawPair(pair, holder) {
  const title = html('h4', {}, html('button', {type: 'button', title: 'show it large', onclick: () => {
    [front.x, front.y] = pair;
    byId('front-x').value = pair[0];
    byId('front-y').value = pair[1];
    drawFronts();
    byId('fronts').scrollIntoView();
  }}, `${metricName(pair[1])} against ${metricName(pair[0])}`));
  drawFront(holder, pair, 220, false);
  holder.prepend(title);
}

function drawFronts() {
  const best = drawFront(byId('front'), [front.x, front.y], Math.min(470, Math.max(320, window.innerWidth * 0.7)), true);
  byId('front-text').textContent = best.length > 0
    ? `On the stairs, from the left: ${costSign(front.x) > 0 ? best.map(pointName).join('; ') : [...best].reverse().map(pointName).join('; ')}.`
    : 'Which of these figures is better, less or more, is not said: there is no front.';
  drawLegend();
  byId('front-pairs').replaceChildren();
  const holders = usualPairs().map(() => html('div', {class: 'multiple'})); // all first: they share the width
  byId('front-pairs').append(...holders);
  usualPairs().forEach((pair, k) => drawPair(pair, holders[k]));
}

function showFronts() {
  if (known.length < 2) {
    byId('front').append(html('p', {class: 'muted'}, 'No two figures are known.'));
    return;
  }
  const entries = known.map(m => [m, metricTitle(m)]), [pair] = usualPairs();
  [front.x, front.y] = pair;
  for (const axis of ['x', 'y']) {
    selectFrom(byId(`front-${axis}`), entries, front[axis]);
    byId(`front-${axis}`).addEventListener('change', event => {
      front[axis] = Number(event.target.value);
      drawFronts();
    });
  }
  onChosen(drawFronts);
  onResize(drawFronts);
}
