"use strict";
// A campaign that flies: its part of the page is asked for again until it has ended.
const part = document.getElementById("part");
async function refresh() {
  try {
    const answer = await fetch(location.pathname + "?part=1", { cache: "no-store" });
    if (answer.status === 404 || answer.redirected) return location.reload();
    if (!answer.ok) throw new Error(answer.statusText);
    part.innerHTML = await answer.text();
    part.classList.remove("away");
    if (answer.headers.get("X-Campaign-Ended") === "1") return part.removeAttribute("data-live");
  } catch (error) {
    part.classList.add("away"); // the coordinator is away: it may come back
  }
  setTimeout(refresh, 2000);
}
if (part && part.hasAttribute("data-live")) setTimeout(refresh, 2000);

// The list: two campaigns are compared, and no more.
const list = document.querySelector("form.campaigns");
if (list) {
  const boxes = [...list.querySelectorAll("input[type=checkbox]")];
  const button = list.querySelector("button");
  const update = () => {
    const marked = boxes.filter((box) => box.checked).length;
    button.disabled = marked !== 2;
    for (const box of boxes) box.disabled = marked >= 2 && !box.checked;
  };
  list.addEventListener("change", update);
  update();
}
