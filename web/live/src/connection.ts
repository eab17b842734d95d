// SPDX-License-Identifier: GPL-3.0-or-later
// The WebSocket. When it closes, it is opened again after a wait that doubles each time up to a few seconds.
import { decode, SUBPROTOCOL, WireError, type Message } from './wire';

export interface ConnectionListener {
  opened(): void;
  message(data: ArrayBuffer): void;
  closed(retryInMs: number): void;
}

const FIRST_WAIT_MS = 250;
const LONGEST_WAIT_MS = 5000;
const MOST_UNSENT_BYTES = 4096;  // with more unsent data, positions of the hand are dropped

export class Connection {
  private socket: WebSocket | null = null;
  private wait = FIRST_WAIT_MS;

  constructor(private readonly address: string) {}

  open(listener: ConnectionListener): void {
    const socket = new WebSocket(this.address, SUBPROTOCOL);
    socket.binaryType = 'arraybuffer';
    socket.addEventListener('open', () => {
      this.wait = FIRST_WAIT_MS;
      listener.opened();
    });
    socket.addEventListener('message', (e) => {
      if (e.data instanceof ArrayBuffer) listener.message(e.data);
    });
    socket.addEventListener('close', () => {
      const wait = this.wait;
      this.wait = Math.min(2 * wait, LONGEST_WAIT_MS);
      listener.closed(wait);
      setTimeout(() => this.open(listener), wait);
    });
    this.socket = socket;
  }

  /** Sends data. @param perishable the data are soon outdated, so they are dropped if the connection is busy */
  send(data: ArrayBuffer, perishable = false): void {
    const { socket } = this;
    if (socket?.readyState !== WebSocket.OPEN || (perishable && socket.bufferedAmount >= MOST_UNSENT_BYTES)) return;
    socket.send(data);
  }
}

/** The address of a path of this server, with the token of the page's own address. */
export function serverAddress(path: string, webSocket = false): string {
  const token = new URLSearchParams(location.search).get('token');
  const address = new URL(path, location.href);
  address.search = token ? `?token=${encodeURIComponent(token)}` : '';
  if (webSocket) address.protocol = address.protocol === 'https:' ? 'wss:' : 'ws:';
  return address.href;
}

/** Decodes a message. A malformed message is reported on the console and ignored. */
export function understood(data: ArrayBuffer): Message | null {
  try {
    return decode(data);
  } catch (error) {
    if (!(error instanceof WireError)) throw error;
    console.warn(`The server sent ${error.message}.`);
    return null;
  }
}
