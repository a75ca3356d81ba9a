// A watched folder: its stamp is read every second, as a script, because a page that is opened from
// disk may fetch nothing. Another stamp is of another page.
function written(stamp) {
  if (stamp !== data.stamp) window.location.reload();
}
setInterval(() => {
  const script = document.createElement("script");
  script.src = `.page.js?${Date.now()}`;
  script.onload = () => script.remove();
  script.onerror = () => script.remove();
  document.head.append(script);
}, 1000);
