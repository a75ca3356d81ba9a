// The end: all panels are there. A page that is loaded again stays where it was.
const again = performance.getEntriesByType("navigation")[0]?.type === "reload";
if (!fromHash()) choose(data.middle, false);
else if (!again) byId("cells").scrollIntoView();
