// The back and the forward button of the browser take the case of the address.
window.addEventListener("popstate", () => emitEvent("visited", location.pathname + location.search));

// What the notice of a lost connection says: whether the page has ended or has been started again.
setInterval(async () => {
  const popup = document.getElementById("popup");
  if (!popup || popup.ariaHidden !== "false") return;
  let words = "The page has ended. Start tehl explore again, and open the address that it prints.";
  try {
    const reply = await fetch("/alive", { cache: "no-store" });
    if (reply.status !== 403) return;
    words = "tehl explore has been started again. Open the new address that its terminal has printed.";
  } catch { /* nothing replies */ }
  popup.replaceChildren(Object.assign(document.createElement("span"), { textContent: words }));
}, 1000);
