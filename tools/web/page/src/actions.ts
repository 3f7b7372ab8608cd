// SPDX-License-Identifier: BSD-3-Clause
// What a person with the token may ask of the running isobard: save the black box, tell where the robot is. The token
// stays in this page's memory.
import { button, element, panel, set_text } from './dom';

function number_input(label: string, unit: string): { root: HTMLElement; input: HTMLInputElement } {
  const input = element('input', '');
  input.type = 'number';
  input.step = 'any';
  return { root: element('label', '', `${label} ${unit}`, input), input };
}

export class Actions {
  readonly root: HTMLElement;
  private readonly token = element('input', 'token');
  private readonly answer = element('p', 'answer', 'Give the token of this robot to use these.');
  private readonly x = number_input('x', 'm');
  private readonly y = number_input('y', 'm');
  private readonly yaw = number_input('yaw', '°');
  /** Outcomes told so far: one that overtakes the answer to its request stands. */
  private outcomes = 0;

  constructor() {
    const { root, body } = panel('Actions', 'actions');
    this.root = root;
    this.token.type = 'password';
    this.token.autocomplete = 'off';
    this.answer.setAttribute('role', 'status');
    const form = element('form', '');
    form.addEventListener('submit', (event) => event.preventDefault());
    body.append(form);
    form.append(
      element('label', '', 'Token', this.token),
      button('Save the black box', 'action', () => void this.send('/api/save-black-box', {})),
      element('div', 'row', this.x.root, this.y.root, this.yaw.root),
      button('The robot is here', 'action', () => this.send_hint()),
      this.answer);
  }

  /** The outcome of an action, which comes later. */
  tell_outcome(text: string, failed: boolean): void {
    ++this.outcomes;
    this.tell(text, failed);
  }

  private tell(text: string, failed: boolean): void {
    set_text(this.answer, text);
    this.answer.classList.toggle('failed', failed);
  }

  private send_hint(): void {
    const [x_m, y_m, yaw_deg] = [this.x, this.y, this.yaw].map(({ input }) => input.valueAsNumber);
    if (![x_m, y_m, yaw_deg].every(Number.isFinite)) return this.tell('x, y and yaw are needed.', true);
    void this.send('/api/initial-pose', { x_m, y_m, yaw_deg });
  }

  private async send(path: string, body: object): Promise<void> {
    this.tell('Asking …', false);
    const before = this.outcomes;
    try {
      const answer = await fetch(path, {
        method: 'POST',
        headers: { Authorization: `Bearer ${this.token.value}`, 'Content-Type': 'application/json' },
        body: JSON.stringify(body),
      });
      const text = (await answer.text()).trim();
      if (this.outcomes === before) this.tell(text, !answer.ok);
    } catch {
      this.tell('isobar web does not answer.', true);
    }
  }
}
