// One robot on the list: what it is, and what can be done with it.

import type { RobotInfo } from '../api';
import { formatNumber, setText, smallButton } from '../dom';

export class RobotRow {
  readonly element = document.createElement('li');
  private readonly facts = document.createElement('span');
  private readonly use: HTMLButtonElement;
  private readonly remove: HTMLButtonElement;

  constructor(name: string, acts: { readonly use: () => void; readonly remove: () => void }) {
    this.element.dataset['robot'] = name;
    const title = document.createElement('strong');
    title.textContent = name;
    this.facts.className = 'muted';
    const actions = document.createElement('div');
    actions.className = 'actions';
    this.use = smallButton('Use', acts.use, `Use ${name}`);
    this.remove = smallButton('Delete', acts.remove, `Delete ${name}`);
    actions.append(this.use, this.remove);
    this.element.append(title, this.facts, actions);
  }

  /** `here`: the robot of this session, which can neither be chosen nor deleted. */
  update(robot: RobotInfo, here: string | undefined): void {
    setText(
      this.facts,
      `${formatNumber(robot.massKg, 1)} kg, CoM at ${formatNumber(robot.comHeightM, 2)} m, ` +
        `${robot.joints.length} joints${robot.uploaded ? ', yours' : ''}`,
    );
    this.use.disabled = robot.name === here;
    this.remove.disabled = robot.name === here;
    this.remove.hidden = !robot.uploaded;
  }
}
