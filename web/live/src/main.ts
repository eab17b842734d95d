// SPDX-License-Identifier: GPL-3.0-or-later
import 'uplot/dist/uPlot.min.css';
import './live.css';
import { Anatomy } from './anatomy';
import { buildChart } from './chart/chart_panel';
import { Connection, serverAddress } from './connection';
import { AgeLabel } from './controls/age_label';
import { Cover } from './controls/cover';
import { makeHelp, makeRecordings } from './controls/dialogs';
import { bindGamepad } from './controls/gamepad';
import { HarmBanner } from './controls/harm_banner';
import { Header } from './controls/header';
import { bindKeys } from './controls/keyboard';
import { showNotices, speakEvents } from './controls/notices';
import { PushBar } from './controls/push_bar';
import { Readouts } from './controls/readouts';
import { ReplayBar } from './controls/replay_bar';
import { Steering } from './controls/steering';
import { TemplatePicker } from './controls/template_picker';
import { nameRegions } from './event_names';
import { HandControl } from './hand';
import { EndCard } from './implant/end_card';
import { ImagePanel } from './imaging/image_panel';
import { offerInterrupted } from './implant/interrupted';
import { ImplantActions, ImplantPanel } from './implant/panel';
import { compose, save } from './picture';
import { Plane } from './sections/plane';
import { SectionPanel } from './sections/section_panel';
import { Session } from './session';
import { ViewPanel } from './view3d/view_panel';

function part(id: string): HTMLElement {
  const element = document.getElementById(id);
  if (!element) throw new Error(`The page has no element "${id}"`);
  return element;
}

const session = new Session(new Connection(serverAddress('live', true)));
session.start();  // first, so that the server answers while the page is built
const hand = new HandControl(session);
const help = makeHelp(session);
const implant = new ImplantActions(session, hand);

// Listeners are called in the order in which they were added, so the anatomy moves before anything draws it.
let anatomy: Anatomy | null = null;
session.on('scene', (scene) => {
  if (scene.case !== anatomy?.scene.case) for (const warning of scene.warnings) session.notify(warning);
  anatomy = new Anatomy(scene);
  nameRegions(scene.regions);
});
session.on('frame', (frame) => anatomy?.show(frame));

new Cover(part('cover'), session);
new AgeLabel(document.body, session);
showNotices(part('notices'), session);
speakEvents(document.body, session);
new Header(part('top'), session, hand, { recordings: makeRecordings(session), picture: takePicture, help });
const view = new ViewPanel(part('view3d'), session, hand);
const images = new ImagePanel(part('image'), part('view3d'), part('tabs'), session);
const planes = [new Plane('transverse', session), new Plane('sagittal', session)];
const sections = planes.map((plane, i) => new SectionPanel(part(plane.name), session, plane, planes[1 - i]));
const chart = buildChart(part('chart'), session);
new HarmBanner(part('harm'), session);
new Readouts(part('readouts'), session);
new TemplatePicker(part('picker'), session, hand);
new Steering(part('steering'), session, hand);
new PushBar(part('push'), session, hand);
new ReplayBar(part('replay'), part('push'), session);
const endCard = new EndCard(session);
new ImplantPanel(part('implant'), session, implant, () => endCard.show());
offerInterrupted(session);
bindKeys(session, hand, implant, images, help);
bindGamepad(hand);

session.on('scene', () => {
  if (!anatomy) return;
  view.setAnatomy(anatomy);
  for (const section of sections) section.view.setAnatomy(anatomy);
});
view.onVisibility = (region, visible) => {
  for (const { view: section } of sections) {
    if (visible) section.hidden.delete(region);
    else section.hidden.add(region);
    section.box.request();
  }
};

function takePicture(): void {
  view.stage?.render();
  const canvas = compose(session, {
    view: view.stage?.canvas ?? null,
    sections: sections.map((s) => ({ title: s.title, canvas: s.view.box.canvas })),
    chart: chart.canvas,
    largest_mm: view.largestColored,
  });
  save(canvas, `stylet-${new Date().toISOString().slice(0, 19).replaceAll(':', '')}.png`);
}
