// The film in step with the clock: the picture whose simulated time is the nearest. At the end of the flight the
// still, where there is one.

import type { Clock } from "./clock";
import { count_until, take_bytes, type Numbers } from "./data";

/// The index of the nearest of the sorted times; the first of equal ones.
function nearest_picture(times: Numbers, time_s: number): number {
  const after = Math.min(count_until(times, time_s), times.length - 1);
  const before = Math.max(after - 1, 0);
  let nearest = time_s - times[before] <= times[after] - time_s ? before : after;
  while (nearest > 0 && times[nearest - 1] === times[nearest]) --nearest;
  return nearest;
}

/// Shows the film and the still that the page holds in `place`; hides `place` where it holds neither.
export function add_film(place: HTMLElement, times: Numbers, clock: Clock): void {
  const has_film = times.length > 0 && document.getElementById("film") !== null;
  const still = take_bytes("still");
  place.hidden = !has_film && !still;
  if (place.hidden) return;
  const caption = place.querySelector("figcaption")!;

  const image = still ? document.createElement("img") : null;
  if (image) {
    image.alt = "The last picture of the flight, frozen";
    image.src = URL.createObjectURL(new Blob([still!], { type: "image/jpeg" }));
    image.addEventListener("error", () => (caption.textContent = "The still cannot be shown."));
    place.prepend(image);
  }
  const video = has_film ? document.createElement("video") : null;
  if (video) {
    video.muted = true;
    video.playsInline = true;
    video.preload = "auto";
    video.setAttribute("aria-label", "What the left camera saw");
    video.addEventListener("error", () => (caption.textContent = "This browser does not play the video (H.264)."));
    // Decoding its text and its first picture takes longer than all the rest, and a video holds up the page's load.
    const show_film = () => (video.src = URL.createObjectURL(new Blob([take_bytes("film")!], { type: "video/mp4" })));
    if (document.readyState === "complete") show_film();
    else addEventListener("load", () => setTimeout(show_film), { once: true });
    place.prepend(video);
    video.addEventListener("loadedmetadata", update);
    video.addEventListener("seeked", update);
  }

  function update(): void {
    const frozen = image !== null && (video === null || clock.time_s >= clock.end_s - 1e-6);
    if (image) image.hidden = !frozen;
    if (video) video.hidden = frozen;
    if (video?.error) return;
    caption.textContent = frozen ? "left camera, and from behind: the frozen frame" : "left camera, and from behind";
    if (!video || video.seeking || !(video.duration > 0)) return; // "seeked" calls again with the newest time
    const middle_s = ((nearest_picture(times, clock.time_s) + 0.5) / times.length) * video.duration;
    if (Math.abs(video.currentTime - middle_s) > (0.25 / times.length) * video.duration) video.currentTime = middle_s;
  }
  clock.subscribe(update);
}
