'use strict';
/* Shared by all sections: the data, elements, the chosen run. Text from the data becomes text nodes
 * and attribute values only, never markup. */

function showTrouble(error) {
  const box = document.getElementById('trouble');
  box.hidden = false;
  box.textContent += `Something on this page does not work: ${error}\n`;
}
window.addEventListener('error', event => showTrouble(event.message));

/** Escapes control characters and direction marks, which can disguise words. */
function visible(key, value) {
  return typeof value !== 'string' ? value : value.replace(/[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]/g,
    letter => `\\u${letter.charCodeAt(0).toString(16).padStart(4, '0')}`);
}

const sweep = JSON.parse(document.getElementById('sweep-data').textContent, visible);
const series = JSON.parse(document.getElementById('series-data').textContent, visible);
const album = JSON.parse(document.getElementById('picture-data').textContent, visible);
const svgNamespace = document.getElementById('marks').namespaceURI;

const byId = id => document.getElementById(id);

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes || {})) {
    if (name.startsWith('on'))
      element.addEventListener(name.slice(2), value);
    else if (value === true)
      element.setAttribute(name, '');
    else if (value !== false && value !== null && value !== undefined)
      element.setAttribute(name, value);
  }
  element.append(...children.flat().filter(child => child !== null && child !== undefined));
  return element;
}

/** An HTML element; attributes whose name begins with "on" are listeners. */
function html(tag, attributes, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

function svg(tag, attributes, ...children) {
  return fill(document.createElementNS(svgNamespace, tag), attributes, children);
}

/** Announces a text to screen readers. */
function say(text) {
  byId('says').textContent = text;
}

async function copyText(text, button) {
  try {
    await navigator.clipboard.writeText(text);
  } catch (refused) { // pages opened from disk may lack clipboard access
    const area = html('textarea', {class: 'hidden'});
    area.value = text;
    document.body.append(area);
    area.select();
    document.execCommand('copy');
    area.remove();
  }
  const before = button.textContent;
  button.textContent = 'copied';
  say('copied');
  setTimeout(() => { button.textContent = before; }, 1200);
}

function copyButton(text, label, name) {
  const button = html('button', {type: 'button', 'aria-label': name || label}, label);
  button.addEventListener('click', () => copyText(text, button));
  return button;
}

/** A command line with a button that copies it. */
function commandLine(text, name) {
  return html('div', {class: 'command'}, html('code', {}, text), copyButton(text, 'copy', `copy ${name}`));
}

function selectFrom(select, entries, value) {
  select.replaceChildren(...entries.map(([key, text]) => html('option', {value: key}, text)));
  select.value = String(value);
}

const points = sweep.points;
const done = points.map((point, index) => index).filter(i => points[i].state === 'done');
const base = points[sweep.base] && points[sweep.base].state === 'done' ? sweep.base : -1;
const chosenListeners = [];
let chosen = -1;

/** Calls the listener now, and whenever another run is chosen. */
function onChosen(listener) {
  chosenListeners.push(listener);
  if (chosen >= 0)
    listener(chosen);
}

function choose(index) {
  if (!points[index] || points[index].state !== 'done' || index === chosen)
    return;
  chosen = index;
  say(`chosen: ${pointName(index)}`);
  chosenListeners.forEach(listener => listener(index));
}

function roles(index) {
  const names = sweep.recommendations.filter(r => r.point === index).map(r => r.name);
  return index === base ? ['base', ...names] : names;
}

function pointName(index) {
  return points[index].label || (index === sweep.base ? 'base' : `run ${index + 1}`);
}

function pointEntries(indices) {
  return indices.map(i => [i, [pointName(i), ...roles(i).filter(r => r !== 'base').map(r => `\u2605 ${r}`)].join('  ')]);
}

/** Indices of the settings in which a point differs from the base. */
function differences(index) {
  const values = points[index].values, usual = points[sweep.base] ? points[sweep.base].values : values;
  return values.map((value, i) => value !== usual[i] ? i : -1).filter(i => i >= 0);
}

const hueCount = 8, shapeCount = 5;
const varied = sweep.settings.map((setting, i) => i).filter(i => points.some((p, k) => {
  const d = differences(k);
  return d.length === 1 && d[0] === i;
}));

/** Returns the group of a point, for color and shape: the one setting that differs, 'several' or 'base'. */
function groupOf(index) {
  const d = differences(index);
  return d.length === 0 ? 'base' : d.length > 1 ? 'several' : d[0];
}

function groupName(group) {
  return group === 'base' || group === 'several' ? group : sweep.settings[group].name;
}

function groupColor(group) {
  if (group === 'base')
    return 'var(--ink)';
  return group === 'several' ? 'var(--other)' : `var(--c${varied.indexOf(group) % hueCount})`;
}

/** Returns a path around (0, 0). */
function groupShape(group, r) {
  const circle = `M${-r} 0A${r} ${r} 0 1 0 ${r} 0A${r} ${r} 0 1 0 ${-r} 0Z`;
  const k = r * 0.9, t = r * 1.15;
  const shapes = [circle, `M${-k} ${-k}H${k}V${k}H${-k}Z`, `M0 ${-t}L${t} ${t * 0.8}H${-t}Z`,
    `M0 ${-t * 1.1}L${t * 1.1} 0L0 ${t * 1.1}L${-t * 1.1} 0Z`, `M0 ${t}L${t} ${-t * 0.8}H${-t}Z`];
  if (group === 'base' || group === 'several')
    return circle;
  const place = varied.indexOf(group);
  return shapes[(place + Math.floor(place / hueCount)) % shapeCount];
}
