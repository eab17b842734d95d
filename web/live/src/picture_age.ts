// SPDX-License-Identifier: GPL-3.0-or-later
// How old the picture of the needle is. The clocks of server and page differ, so the server measures: from the moment at
// which it had a picture to the moment at which the page said that it had taken it up (`lag_s` in the status). What has
// passed since the last picture is added by the page's own clock.
import type { Session } from './session';

const WORTH_SAYING_S = 0.3;
const SILENT_S = 1;  // while the needle is live, a picture comes several times a second also when nothing moves

type Seen = Pick<Session, 'connected' | 'status' | 'frame' | 'frameAt' | 'replaying'>;

/** Whether time passes in what is shown. Otherwise no picture comes, and the last one is right. */
function goesOn({ connected, status, frame, replaying }: Seen): boolean {
  return connected && status?.state === 'ready' && frame !== null && !frame.paused && (!replaying || status.replay?.playing === true);
}

/** The age in words; empty where it does not matter. @param now [ms] performance.now() */
export function ageInWords(session: Seen, now: number): string {
  if (!goesOn(session)) return '';
  const since = (now - session.frameAt) / 1000;
  const age = (session.status?.lag_s ?? 0) + since;
  if (age <= WORTH_SAYING_S) return '';
  return `The picture is ${age.toFixed(1)} s old: ${since > SILENT_S ? 'no newer one has come' : 'the connection is slow'}.`;
}
