// SPDX-License-Identifier: BSD-3-Clause
// Start of the page: asks the server what there is to see, and opens the page for it.
import './style.css';
import { element } from './dom';
import { has_inline_view, InlineSource } from './inline_source';
import { LivePage } from './live_page';
import { LiveSource } from './live_source';
import { RunPage } from './run_page';
import { fetch_ok, RunSource } from './run_source';
import type { ViewData } from './view_data';

const kRetryMs = 1000;

async function first_view(): Promise<ViewData> {
  for (;;) {
    try {
      return (await (await fetch_ok('/api/view')).json()) as ViewData;
    } catch (error) {
      document.body.replaceChildren(element('p', 'first', `isobar web does not answer: ${(error as Error).message}. Trying again every second.`));
      await new Promise((resolve) => setTimeout(resolve, kRetryMs));
    }
  }
}

async function start(): Promise<void> {
  if (has_inline_view()) {
    new InlineSource().start(new RunPage());
    return;
  }
  const view = await first_view();
  if (view.kind === 'live') new LiveSource(view).start(new LivePage());
  else new RunSource(view).start(new RunPage());
}

void start();
