// One push on the list: what it is, what became of it, and how to take it back before it acts.

import { formatNumber, formatShort, setText, smallButton } from '../dom';
import type { PushResource } from '../push_body';
import { directionName } from '../push_request';

export class PushRow {
  readonly element = document.createElement('tr');
  private readonly what = this.element.insertCell();
  private readonly state = this.element.insertCell();
  private readonly delivered = document.createElement('span');
  private readonly last = this.element.insertCell();
  private readonly cancel: HTMLButtonElement;

  constructor({ id }: PushResource, cancel: () => void) {
    this.cancel = smallButton('Cancel', cancel, `Cancel push ${id}`);
    this.delivered.title = 'Impulse that has acted on the robot';
  }

  /** A push on the torso needs no word of it. */
  update(push: PushResource, torsoLink: string): void {
    this.element.className = `state-${push.state}`;
    setText(
      this.what,
      `${push.id}. ${formatShort(push.impulseNs, 3)} N s ${directionName(push.directionDeg)}` +
        (push.link === torsoLink ? '' : `, ${push.link}`),
    );
    setText(this.state, push.state);
    setText(this.delivered, `${formatNumber(push.deliveredNs, 2)} N s`);
    const last = push.state === 'scheduled' ? this.cancel : this.delivered;
    if (this.last.firstChild !== last) this.last.replaceChildren(last);
  }
}
