
// The end: all panels are there.
if (!fromHash()) choose(data.middle, false);
