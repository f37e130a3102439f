'use strict';
/* A section that fails is named, and leaves the others alone. */

function attempt(section) {
  try {
    section();
  } catch (error) {
    showTrouble(`${section.name}: ${error.message}`);
  }
}

[showTheme, showHead, showRecommendations, showChosen, showFronts, showEffects, showSeries, showPictures, showTable].forEach(attempt);

/* The first choice is what most want to know: the balanced one, else what is recommended first. */
const offered = sweep.recommendations.filter(r => done.includes(r.point) && r.point !== base);
attempt(function firstChoice() {
  const first = offered.find(r => r.name === 'balanced') || offered[0];
  choose(first ? first.point : base >= 0 ? base : done[0]);
});
document.documentElement.dataset.ready = byId('trouble').hidden ? 'yes' : 'no';
