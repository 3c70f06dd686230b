// The program of the page: reads the facts and shows the page of their kind.

import { show_campaign } from "./campaign_page";
import { read_arrays, read_facts, take_bytes } from "./data";
import { make } from "./elements";
import type { CampaignFacts, FlightFacts, SheetFacts } from "./facts";
import { show_flight } from "./flight_page";
import { show_sheet } from "./sheet_page";

function say(sentence: string): void {
  document.body.append(make("p", sentence, "alone"));
}

function show_page(): void {
  const facts = read_facts() as FlightFacts | CampaignFacts | SheetFacts | null;
  if (facts === null) return say("This page holds no flight. `understory fly` writes one that does.");
  document.title = `Understory: ${facts.title}`;
  const arrays = read_arrays(facts.arrays, take_bytes("arrays"));
  if (facts.kind === "flight") show_flight(document.body, facts, arrays);
  else if (facts.kind === "campaign") show_campaign(document.body, facts, arrays);
  else if (facts.kind === "sheet") show_sheet(document.body, facts, arrays);
  else say(`This page cannot show what it holds: "${(facts as { kind: unknown }).kind}".`);
}

document.documentElement.dataset.theme = window.matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
try {
  show_page();
} catch (error) {
  say(`This page is damaged: ${error instanceof Error ? error.message : error}`);
}
