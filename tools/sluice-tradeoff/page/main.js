'use strict';
/* Draws all sections. If one fails, the page names it and shows the others. */

function attempt(section) {
  try {
    section();
  } catch (error) {
    showTrouble(`${section.name}: ${error.message}`);
  }
}

[showTheme, showHead, showRecommendations, showChosen, showFronts, showEffects, showSeries, showPictures, showTable].forEach(attempt);

/* Choose the balanced run first, or else the first recommended one. */
const offered = sweep.recommendations.filter(r => done.includes(r.point) && r.point !== base);
attempt(function firstChoice() {
  const first = offered.find(r => r.name === 'balanced') || offered[0];
  choose(first ? first.point : base >= 0 ? base : done[0]);
});
document.documentElement.dataset.ready = byId('trouble').hidden ? 'yes' : 'no';
