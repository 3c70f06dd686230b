// The program of the page: reads the facts and shows the page of their kind.

import { read_facts } from "./data";
import type { FlightFacts } from "./facts";
import { show_flight } from "./flight_page";

function say(sentence: string): void {
  const line = document.body.appendChild(document.createElement("p"));
  line.className = "alone";
  line.textContent = sentence;
}

try {
  const facts = read_facts();
  if (facts === null) say("This page holds no flight. `understory fly` writes one that does.");
  else if (facts.kind === "flight") show_flight(facts as FlightFacts);
  else say(`This page cannot show what it holds: "${facts.kind}".`);
} catch (error) {
  say(`This page is damaged: ${error instanceof Error ? error.message : error}`);
}
