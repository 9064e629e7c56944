#pragma once

#include <string>
#include <string_view>

namespace rondure::web {

/// The page. Without control it has no stop button.
[[nodiscard]] std::string live_page(bool control);

/// The style of the report, with the additions for the live page.
[[nodiscard]] std::string live_style();

/// Script of the page: fetches changed parts four times a second and shows when the program does
/// not answer; stops the run after the button and the question were confirmed, with the token after
/// "#" in the address. It computes and draws nothing.
inline constexpr std::string_view kLiveScript = R"js('use strict';
(() => {
  const byId = (id) => document.getElementById(id);
  const client = Math.random().toString(36).slice(2, 12);
  const token = new URLSearchParams(location.hash.slice(1)).get('token') || '';
  let session = '', version = 0, failures = 0, ended = false;

  const show = (id, on) => { const e = byId(id); if (e && e.hidden === on) e.hidden = !on; };

  const put = (frame) => {
    if (session && frame.session !== session) { location.reload(); return; }
    session = frame.session;
    version = frame.version;
    ended = frame.ended;
    for (const [id, html] of Object.entries(frame.parts)) {
      const place = byId(id);
      if (place) place.innerHTML = html;
    }
    if (frame.title) document.title = frame.title;
    document.body.dataset.state = ended ? 'ended' : 'running';
  };

  const ask = async () => {
    try {
      const answer = await fetch(`live?since=${version}&client=${client}`,
                                 { cache: 'no-store', signal: AbortSignal.timeout(4000) });
      if (!answer.ok) throw new Error(String(answer.status));
      put(await answer.json());
      failures = 0;
    } catch {
      ++failures;
    }
    const lost = failures > 1 && !ended;
    show('lost', lost);
    show('control', token !== '' && !ended && !lost);
    show('no-token', token === '' && !ended);
    if (!ended) setTimeout(ask, failures > 0 ? 1000 : 250);
  };

  const stop = async () => {
    for (const id of ['asked', 'refused']) show(id, false);
    try {
      const answer = await fetch('stop', { method: 'POST', body: '{}', headers:
          { 'Content-Type': 'application/json', 'X-Rondure-Token': token } });
      show(answer.ok ? 'asked' : 'refused', true);
      byId('stop').disabled = answer.ok;
    } catch {
      show('refused', true);
    }
  };

  const button = byId('stop');
  if (button) {
    const question = byId('question');
    button.addEventListener('click', () => question.showModal());
    question.addEventListener('close', () => {
      if (question.returnValue === 'stop') stop();
      question.returnValue = '';
    });
    byId('yes').addEventListener('click', () => question.close('stop'));
    byId('no').addEventListener('click', () => question.close(''));
  }
  ask();
})();
)js";

}  // namespace rondure::web
