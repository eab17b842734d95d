// SPDX-License-Identifier: GPL-3.0-or-later
// The server says events in words (Event.label); this page decides which of them are harm.
import type { Event } from './wire';

const BONE_OR_OUT = new Set(['bone_contact', 'exited']);
let spared = new Set<string>();
let labels = new Map<string, string>();

/** Sets the labels of the regions of the case that is shown. */
export function nameRegions(regions: { name: string; label: string; spared?: boolean }[]): void {
  spared = new Set(regions.filter((r) => r.spared).map((r) => r.name));
  labels = new Map(regions.map((r) => [r.name, r.label.toLowerCase()]));
}

export function regionLabel(name: string): string {
  return labels.get(name) ?? name;
}

/** The events that have words of their own. Entering a region by a puncture has none: the puncture has said it. */
export function withWords(events: readonly Event[]): Event[] {
  return events.filter((event) => event.label !== '');
}

/** Whether an event harms the patient: the needle enters an organ to be spared, meets bone or leaves the body. */
export function isHarm(event: Event): boolean {
  return BONE_OR_OUT.has(event.kind) || (event.kind === 'region_entered' && spared.has(event.region));
}

/** Whether the words of an event say a harm. Those of a puncture do, of which the harm is the next event. */
export function saysHarm(event: Event): boolean {
  return isHarm(event) || (event.kind === 'puncture' && spared.has(event.region));
}

export function harmSentence(event: Event): string {
  const at = `at ${event.depth_mm.toFixed(0)} mm`;
  if (event.kind === 'exited') return `Needle came out of the body ${at}`;
  const region = event.region ? regionLabel(event.region) : 'tissue';
  return event.kind === 'bone_contact' ? `Needle met bone (${region}) ${at}` : `Needle entered the ${region} ${at}`;
}
