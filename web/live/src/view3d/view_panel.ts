// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D view with its controls: visible parts, colours, cut, and direction of view.
import { contactKey, colorBar, scaleMarks } from '../../../shared/keys';
import { button, element, radioButtons, switchOf } from '../../../shared/dom';
import { regionRow, rowName } from '../../../shared/region_look';
import { VIEWS } from '../../../shared/views';
import { Anatomy } from '../anatomy';
import type { Session } from '../session';
import type { HandControl } from '../hand';
import { samePatient } from '../scene';
import { wheelNotches } from '../wheel';
import type { Frame } from '../wire';
import { CutControl } from './cut_control';
import { tipErrorKey } from './tip_error_key';
import type { RegionSurface } from './region_surface';
import { Stage } from './stage';

const SMALLEST_SCALE_MM = 0.5;

/** A check box that shows or hides an object of the stage. */
function visibilityBox(stage: Stage, thing: { object: { visible: boolean } }, text: string): HTMLElement {
  return switchOf(text, thing.object.visible, null, (on) => {
    thing.object.visible = on;
    stage.draw();
  });
}

/**
 * The 3D view is built last when the page opens, because making a WebGL context may block the page for a second or
 * more.
 */
export class ViewPanel {
  stage: Stage | null = null;
  onVisibility: (region: number, visible: boolean) => void = () => {};
  private anatomy: Anatomy | null = null;
  private byDisplacement = false;
  private most = SMALLEST_SCALE_MM;  // [mm] end of the colour scale
  private readonly settings = element('details', 'settings');
  private readonly list = element('div', 'regions');
  private readonly scale = element('div', 'view-scale');
  private readonly note = element('p', 'view-note');
  private readonly picture = element('div', 'canvas');
  private readonly bar = element('div', 'scale-bar');
  private cutControl: CutControl | null = null;
  private opening = false;
  private mode: string | undefined;
  private seedsWanted = true;
  private readonly seedsBox = switchOf('Seeds, planned and dropped', this.seedsWanted, null, (on) => {
    this.seedsWanted = on;
    this.showSeeds();
  });

  constructor(private readonly root: HTMLElement, private readonly session: Session, hand: HandControl) {
    root.append(this.picture, this.bar, this.scale, this.note);
    this.picture.append(element('p', 'preparing', 'The 3D view is being prepared.'));
    this.bar.hidden = true;
    this.note.hidden = true;
    this.scale.hidden = true;
    // The wheel pushes the needle; with Ctrl it zooms.
    root.addEventListener('wheel', (e) => {
      if (e.ctrlKey || this.settings.contains(e.target as Node)) return;
      e.preventDefault();
      e.stopPropagation();
      hand.push(wheelNotches(e));
    }, { capture: true, passive: false });
    session.on('frame', () => this.update());
    for (const topic of ['plan', 'implant', 'seeds'] as const) session.on(topic, () => this.showSeeds());
    session.on('image', (image) => {
      this.stage?.probe.show(image.probe);
      this.stage?.draw();
    });
    session.on('restart', () => this.setScale(SMALLEST_SCALE_MM));
    session.on('status', (status) => {
      this.stage?.template.mark(status.hole ?? '');
      if (this.mode !== status.mode) this.showSeeds();
      this.mode = status.mode;
      this.openSoon();
    });
  }

  /** [mm] end of the colour scale; null unless colours show the displacement. */
  get largestColored(): number | null {
    return this.byDisplacement ? this.most : null;
  }

  setAnatomy(anatomy: Anatomy): void {
    const again = this.anatomy !== null && samePatient(this.anatomy.scene, anatomy.scene);
    this.anatomy = anatomy;
    if (this.stage) {
      this.showAnatomy(this.stage, anatomy, again);
    } else {
      this.openSoon();
    }
  }

  /** Opens the 3D view when the needle can be moved and the other parts of the page have been painted. */
  private openSoon(): void {
    if (this.opening || !this.anatomy || this.session.status?.state !== 'ready') return;
    this.opening = true;
    requestAnimationFrame(() => setTimeout(() => this.open()));
  }

  private open(): void {
    this.stage = this.makeStage();
    const drawn = () => this.session.command({ do: 'drawn' });
    if (!this.stage) return drawn();
    this.stage.onFirstPicture = drawn;
    this.bar.hidden = false;
    this.buildSettings(this.stage);
    if (!this.anatomy) return;
    this.showAnatomy(this.stage, this.anatomy, false);
    this.showSeeds();
    this.stage.template.mark(this.session.status?.hole ?? '');
    const { frame } = this.session;
    if (!frame) return;
    this.fitScale(this.anatomy.largest);  // perhaps nothing moves from now on
    this.stage.showNeedle(frame);
    this.showNote(frame);
  }

  private showAnatomy(stage: Stage, anatomy: Anatomy, again: boolean): void {
    stage.setAnatomy(anatomy, again);
    if (!again) {
      this.cutControl?.setScene(anatomy.scene);
      stage.probe.show(null);
    }
    this.list.replaceChildren(...stage.surfaces.map((surface, i) => this.rowOf(stage, surface, i)));
    for (const surface of stage.surfaces) surface.colorByDisplacement(this.byDisplacement);
    stage.showTissue(this.most);
  }

  private showSeeds(): void {
    this.seedsBox.hidden = this.session.plan === null;
    this.stage?.seeds.show(this.session, this.seedsWanted);
    this.stage?.draw();
  }

  private makeStage(): Stage | null {
    const { picture, bar } = this;
    picture.replaceChildren();
    try {
      return new Stage(picture, (mm, px) => {
        const text = `${mm} mm`;
        if (bar.textContent !== text) bar.textContent = text;
        bar.style.width = `${px.toFixed(0)}px`;
      });
    } catch {
      picture.replaceChildren(element('p', 'no-webgl',
        'This browser offers no WebGL, which the 3D view needs. The sections and the curves work without it. Use a current browser and switch hardware acceleration on.'));
      return null;
    }
  }

  private update(): void {
    const { frame } = this.session;
    if (!frame || !this.anatomy || !this.stage) return;
    if (this.anatomy.tissueMoved) {
      this.fitScale(this.anatomy.largest);
      this.tissueChanged();
    }
    if (this.anatomy.needleMoved) this.stage.showNeedle(frame);
    this.showNote(frame);
  }

  private fitScale(largest: number): void {
    if (largest > this.most) this.setScale(largest);
  }

  private showNote(frame: Frame): void {
    const note = this.notShown(frame.hidden);
    if (this.note.textContent !== note) {
      this.note.textContent = note;
      this.note.hidden = note === '';
    }
  }

  /** Says which part of the tissue's motion the picture does not show. */
  private notShown(hidden_N: number): string {
    const { status } = this.session;
    if (status?.mode !== 'replay' && status?.stage) {
      const done = status.fraction == null ? '' : ` is being prepared: ${Math.round(100 * status.fraction)} %`;
      return `${status.stage[0].toUpperCase()}${status.stage.slice(1)}${done}.`;
    }
    return hidden_N > 0.05 ? `The displacement is shown without the effect of forces of ${hidden_N.toFixed(1)} N.` : '';
  }

  private tissueChanged(): void {
    this.stage?.showTissue(this.most);
  }

  private setScale(largest: number): void {
    const marks = scaleMarks(largest);
    this.most = marks[marks.length - 1];
    this.scale.replaceChildren(colorBar(marks));
    this.tissueChanged();
  }

  private buildSettings(stage: Stage): void {
    const summary = element('summary', '', 'View');
    summary.title = 'Choose what the 3D view shows';
    const colors = radioButtons('colors', [['Tissue', false], ['Displacement', true]] as const, (on) => {
      this.byDisplacement = on;
      this.scale.hidden = !on;
      for (const surface of stage.surfaces) surface.colorByDisplacement(on);
      stage.showTissue(this.most);
    });
    const contacts = visibilityBox(stage, stage.contacts, 'Contact points');
    const ghost = visibilityBox(stage, stage.ghost, 'Gland before the insertion');
    const tipError = visibilityBox(stage, stage.tipError, 'Tip off its target, drawn in the patient at rest');
    this.cutControl = new CutControl(stage);
    const body = element('div', 'settings-body');
    body.append(element('h3', '', 'Colours'), colors, element('h3', '', 'Cut open'), this.cutControl.element,
                element('h3', '', 'Shown'), this.list, this.seedsBox, ghost, tipError, tipErrorKey(), contacts, contactKey());
    this.settings.append(summary, body);
    const views = element('div', 'views');
    const names = ['Oblique', 'Left', 'Front', 'Feet'];
    VIEWS.forEach((view, i) => {
      const b = button(names[i], () => stage.look(view.from));
      b.title = i === 0 ? 'Reset the view' : view.name;
      views.append(b);
    });
    const closer = button('+', () => stage.zoom(1.25));
    closer.setAttribute('aria-label', 'Closer');
    const farther = button('−', () => stage.zoom(0.8));
    farther.setAttribute('aria-label', 'Farther away');
    views.append(closer, farther);
    this.root.append(views, this.settings);
  }

  private rowOf(stage: Stage, surface: RegionSurface, i: number): HTMLElement {
    let visible = surface.visible;
    return regionRow(surface, rowName(surface.region), surface.region.color, () => {
      if (surface.visible !== visible) this.onVisibility(i, (visible = surface.visible));
      surface.applyLook();
      surface.update(this.most);  // a hidden surface is not updated
      stage.cut.refresh();
      stage.draw();
    });
  }
}
