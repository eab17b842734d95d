// SPDX-License-Identifier: GPL-3.0-or-later
// The test Commands.* writes this file from the table in src/serve/commands.cpp.

/** A command to the server (docs/live_protocol.md). */
export type Command =
  | { do: 'take' }
  | { do: 'release' }
  | { do: 'go_on' }
  | { do: 'hole'; hole: string }
  | { do: 'insertion'; index: number }
  | { do: 'needle'; index: number }
  | { do: 'interrupted'; go_on: 0 | 1 }
  | { do: 'reset' }
  | { do: 'case'; index: number }
  | { do: 'predict'; on: 0 | 1 }
  | { do: 'drawn' }
  | { do: 'pause' }
  | { do: 'resume' }
  | { do: 'step'; count: number }
  | { do: 'drop' }
  | { do: 'undo' }
  | { do: 'clear' }
  | { do: 'replay'; name: string }
  | { do: 'seek'; time_s: number }
  | { do: 'play'; rate: number }
  | { do: 'live' }
  | { do: 'image'; show: 'none' | 'transverse' | 'sagittal' | 'xray' }
  | { do: 'set'; key: string; value: number };
