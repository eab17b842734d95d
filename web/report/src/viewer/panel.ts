// SPDX-License-Identifier: GPL-3.0-or-later
// The interactive view: stage, time slider, and controls of its appearance.
import type { ReportData } from '../data';
import type { Moment } from '../moment';
import { button, element, radioButtons, setSlider, slider, switchOf } from '../../../shared/dom';
import { colorBar, contactKey, scaleMarks } from '../../../shared/keys';
import { regionRow, rowName } from '../../../shared/region_look';
import { openStage } from '../stage_box';
import { Stage } from './stage';

function regionList(stage: Stage): HTMLElement {
  const list = element('div', 'regions');
  for (const mesh of stage.regions) {
    list.append(regionRow(mesh, rowName(mesh.region), mesh.region.color, () => {
      mesh.applyLook();
      stage.draw();
    }));
  }
  return list;
}

function contactList(stage: Stage): HTMLElement {
  const row = element('div', 'contacts');
  const { object } = stage.contacts;
  const shown = switchOf('Contact points', true, null, (on) => {
    object.visible = on;
    stage.draw();
  });
  row.append(shown, contactKey());
  return row;
}

function colorChoice(stage: Stage, bar: HTMLElement): HTMLElement {
  bar.hidden = true;
  return radioButtons('viewer-color', [['Tissue', false], ['Displacement', true]] as const, (on) => {
    for (const mesh of stage.regions) mesh.colorByDisplacement(on);
    bar.hidden = !on;
    stage.draw();
  });
}

/** The factors by which the tissue's displacement may be exaggerated. */
const EXAGGERATIONS = [1, 5, 20];

/** The choice of the factor. @param note text in the picture that states it @param set receives the new factor */
function exaggerationChoice(note: HTMLElement, set: (times: number) => void): HTMLElement {
  return radioButtons('viewer-exaggeration', EXAGGERATIONS.map((times) => [`×${times}`, times] as const), (times) => {
    note.textContent = times === 1 ? '' : `The displacement of the tissue is drawn ×${times}, the needle at its true position.`;
    note.hidden = times === 1;
    set(times);
  });
}

function timeControls(moment: Moment): HTMLElement {
  const row = element('div', 'time');
  const place = slider('Moment of the run', '1', (index) => {
    stop();
    moment.set(index);
  });
  const text = element('output');
  let timer = 0;
  const stop = () => {
    clearInterval(timer);
    timer = 0;
    play.textContent = 'Play';
  };
  const play = button('Play', () => {
    if (timer) return stop();
    if (moment.index === moment.count - 1) moment.set(0);
    play.textContent = 'Pause';
    timer = window.setInterval(() => {
      if (moment.index === moment.count - 1) stop();
      else moment.set(moment.index + 1);
    }, 120);
  });
  play.className = 'play';
  const update = () => {
    setSlider(place, 0, moment.count - 1, moment.index);
    const { time_s: time, depth_mm: depth, label } = moment.frame;
    text.textContent = `${time.toFixed(2)} s, depth ${depth.toFixed(1)} mm${label ? ` – ${label}` : ''}`;
  };
  moment.onChange(update);
  update();
  row.append(play, place, text);
  return row;
}

export function buildViewer(data: ReportData, moment: Moment, root: HTMLElement): void {
  const opened = openStage(root, (box, scaleBar) => new Stage(data, box, scaleBar),
    'the interactive view needs. The pictures below show the same scene before, during and after the insertion.');
  if (!opened) return;
  const { stage, picture, views } = opened;
  const note = element('div', 'exaggeration');
  note.hidden = true;
  picture.append(note);
  const marks = scaleMarks(data.displacement_max_mm);
  const most = marks[marks.length - 1];
  const side = element('div', 'side');
  const scale = colorBar(marks);
  let times = 1;
  const update = () => stage.show(moment.frame, most, times);
  const exaggeration = exaggerationChoice(note, (chosen) => {
    times = chosen;
    update();
  });
  side.append(element('h3', '', 'Colours'), colorChoice(stage, scale), scale, element('h3', '', 'Displacement drawn'),
              exaggeration, element('h3', '', 'Shown'), regionList(stage),
              contactList(stage), element('h3', '', 'View'), views,
              element('p', 'hint', 'Drag to turn, wheel to zoom, right button to move.'));
  root.append(side, timeControls(moment));
  moment.onChange(update);
  update();
}
