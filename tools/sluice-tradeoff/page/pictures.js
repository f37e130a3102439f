'use strict';
/* Compares the drawn picture with the truth, separated by a line that can be moved. */

const viewer = {set: null, left: 'streamed', right: 'truth'};

function pictureUrl(index) {
  return `data:image/png;base64,${album.pool[index].png}`;
}

function image(index, text) {
  const {width, height} = album.pool[index];
  return html('img', {src: pictureUrl(index), width, height, alt: text, draggable: 'false'});
}

/** Reason why a run has pictures: its role, or the metric in which it is extreme. */
function roleText(set) {
  const metric = sweep.metrics.findIndex(m => m.name === set.metric);
  return metric >= 0 ? `${set.role} ${metricName(metric)}` : set.role;
}

function qualityText(set) {
  const bin = data => data && data.step === 1 ? data.most[set.frame] : NaN;
  const psnr = bin(seriesOf(set.point, 'psnr_db')), flip = bin(seriesOf(set.point, 'flip'));
  return [Number.isNaN(psnr) ? null : `PSNR ${formatValue(psnr, 'dB')}`, Number.isNaN(flip) || flip === undefined ? null : `FLIP ${digits(flip, 3)}`].filter(Boolean).join(', ');
}

/** key -> [name, picture] of all choices for a side, other runs at this frame included. */
function choices(set) {
  const found = new Map();
  for (const [kind, name] of [['streamed', 'streamed'], ['truth', 'truth'], ['flip', 'FLIP map']])
    if (set[kind] >= 0)
      found.set(kind, [name, set[kind]]);
  for (const other of album.sets)
    if (other.frame === set.frame && other.point !== set.point)
      found.set(`run ${other.point}`, [`${roleText(other)}: ${pointName(other.point)}`, other.streamed]);
  return found;
}

/** Stacks two pictures, with a movable line between them. */
function stage(left, right) {
  const top = image(left[1], left[0]), bar = html('div', {class: 'bar'});
  const slider = html('input', {type: 'range', class: 'wipe', min: 0, max: 100, step: 0.5, value: 50, 'aria-label': `how much of ${left[0]} is shown over ${right[0]}`});
  const move = () => {
    top.style.clipPath = `inset(0 ${100 - slider.value}% 0 0)`;
    bar.style.left = `${slider.value}%`;
  };
  slider.addEventListener('input', move);
  const box = html('div', {class: 'stage'}, image(right[1], right[0]), top, bar, html('span', {class: 'side left'}, left[0]), html('span', {class: 'side right'}, right[0]));
  const follow = event => {
    if (event.type === 'pointermove' && event.buttons === 0 && event.pointerType !== 'mouse')
      return;
    const area = box.getBoundingClientRect();
    slider.value = 100 * (event.clientX - area.left) / area.width;
    move();
  };
  box.addEventListener('pointermove', follow);
  box.addEventListener('pointerdown', follow);
  move();
  return [box, slider];
}

function drawThree(set) {
  const shown = [['streamed', 'streamed'], ['truth', 'truth: everything resident'], ['flip', 'FLIP map: how visible the difference is']].filter(([kind]) => set[kind] >= 0);
  return html('div', {class: 'three'}, shown.map(([kind, text]) => html('figure', {}, image(set[kind], text), html('figcaption', {}, text))));
}

function sideSelect(side, all) {
  const select = html('select', {onchange: event => { viewer[side] = event.target.value; drawPictures(); }});
  if (!all.has(viewer[side]))
    viewer[side] = side === 'left' || !all.has('truth') ? 'streamed' : 'truth';
  selectFrom(select, [...all].map(([key, [name]]) => [key, name]), viewer[side]);
  return html('label', {}, side, select);
}

function setSelect() {
  const select = html('select', {onchange: event => { viewer.set = album.sets[Number(event.target.value)]; drawPictures(); }});
  for (const point of new Set(album.sets.map(set => set.point))) {
    const mine = album.sets.filter(set => set.point === point);
    select.append(html('optgroup', {label: `${roleText(mine[0])}: ${pointName(point)}`}, mine.map((set, i) =>
      html('option', {value: album.sets.indexOf(set), selected: set === viewer.set},
        `${roleText(set)}, frame ${set.frame}${i === 0 ? ', the worst of its pictures' : ''}${qualityText(set) ? ` (${qualityText(set)})` : ''}`))));
  }
  return html('label', {}, 'run and frame', select);
}

function drawPictures() {
  const {set} = viewer, all = choices(set), large = html('input', {type: 'checkbox', checked: viewer.large});
  const sides = html('div', {class: 'controls'}, setSelect(), sideSelect('left', all), sideSelect('right', all), html('label', {}, large, ' twice as large'));
  const [box, slider] = stage(all.get(viewer.left), all.get(viewer.right)), frame = html('div', {class: viewer.large ? 'viewer large' : 'viewer'}, box);
  large.addEventListener('change', () => {
    viewer.large = large.checked;
    frame.classList.toggle('large', large.checked);
  });
  byId('picture-body').replaceChildren(sides, html('p', {class: 'muted small'}, `${pointName(set.point)}, frame ${set.frame}${qualityText(set) ? `: ${qualityText(set)}` : ''}`), frame, slider, drawThree(set));
}

/** Shows how many runs have pictures, and lists the frames that were left out. */
function showMissingPictures() {
  const there = new Set(album.sets.map(set => set.point)), rest = done.filter(i => !there.has(i)).length;
  const lines = album.left_out.map(gone => html('li', {}, `${pointName(gone.point)}, frame ${gone.frame}: ${gone.why}`));
  byId('picture-missing').replaceChildren(html('p', {class: 'muted small'},
    `Pictures are on this page for ${there.size} of ${done.length} runs: the base, what is recommended, and extremes.` +
    (rest > 0 ? ' Pictures of other runs are in their folders.' : '')),
  lines.length > 0 ? html('details', {class: 'note small'}, html('summary', {}, lines.length === 1 ? 'One frame was left out' : `${lines.length} frames were left out`), html('ul', {}, lines)) : '');
}

function showPictures() {
  showMissingPictures();
  if (album.sets.length === 0) {
    byId('picture-body').append(html('p', {class: 'muted'}, 'There are no pictures on this page.'));
    return;
  }
  viewer.set = album.sets[0];
  onChosen(index => {
    const mine = album.sets.find(set => set.point === index);
    if (mine)
      viewer.set = mine;
    drawPictures();
    if (!mine)
      byId('picture-body').prepend(html('p', {class: 'note'}, `There are no pictures of the chosen run (${pointName(index)}) on this page; these are of another.`));
  });
  if (chosen < 0)
    drawPictures();
}
