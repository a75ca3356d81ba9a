# `make outputs` and `make test` set up all they need in .venv; nothing outside this folder changes.
DESIGN ?= design/fingertip.toml
OUT ?= outputs
PYTHON ?= python3
BIN := .venv/bin
FAB := .venv/.lumitip-fab
READOUT := .venv/.lumitip-readout
DEV := .venv/.lumitip-dev
DOCS := .venv/.lumitip-docs
SITE := .venv/.lumitip-site
BENCHES = fab boards estimation second_light pose_speed dead_cells published_law learning tolerance goals goals_search accept real_frame real_misfit processing protocol links twin environments policy mujoco view page watch acceptance corpus mutations
CHECK = $(BIN)/lumitip-fab check --out "$(OUT)" --junit "$(OUT)/checks.xml" --report "$(OUT)/checks.json"

.DEFAULT_GOAL := help
# Where this is set, as in many containers, every process would compile all that it imports.
unexport PYTHONDONTWRITEBYTECODE
.PHONY: help outputs check readout watch test lint fuzz bench pictures site schema golden dist lock bills clean

help: ## show this list
	@grep -hE '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## /  make \1\t/' | expand -t 18

# What a target needs is installed when it is first asked for: outputs need nothing of the tests.
$(FAB): pyproject.toml constraints.txt
	@$(PYTHON) generators/setup_venv.py fab && touch $@

$(READOUT): $(FAB)
	@$(PYTHON) generators/setup_venv.py readout && touch $@

$(DEV): $(FAB)
	@$(PYTHON) generators/setup_venv.py dev && touch $@

$(DOCS): $(FAB)
	@$(PYTHON) generators/setup_venv.py docs && touch $@

$(SITE): $(FAB)
	@$(PYTHON) generators/setup_venv.py site && touch $@

outputs: $(FAB) ## build DESIGN into OUT, check it, and write its page
	@$(BIN)/lumitip-fab build "$(DESIGN)" --out "$(OUT)"
	@rm -f "$(OUT)/checks.json" "$(OUT)/checks.xml"
	@$(CHECK) --memory "$(OUT)/.checked.json"; checked=$$?; \
	$(BIN)/lumitip-fab page --out "$(OUT)" && exit $$checked

check: $(FAB) ## re-read every file in OUT and prove that they fit
	$(CHECK)

readout: $(READOUT) ## add what reads a fingertip (live view, Bluetooth, serial line) to .venv

watch: $(FAB) ## build and check whenever DESIGN is saved; an open page is loaded again
	$(BIN)/lumitip-fab watch "$(DESIGN)" --out "$(OUT)" --page

test: $(DEV) ## run the tests
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -n auto --dist loadfile

lint: $(DEV) ## format, lint, types, licences, schema
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/mypy --config-file tests/mypy.ini
	REUSE_ENCODING_MODULE=charset_normalizer $(BIN)/reuse lint --lines
	@$(BIN)/lumitip-fab schema | diff -u design/schema.json - || \
	  { echo "design/schema.json is stale: make schema"; exit 1; }

fuzz: $(DEV) ## feed a million damaged inputs to all that reads bytes from outside
	$(BIN)/python -m fuzz

bench: $(DEV) ## measure speed and growth; every part runs, then it fails if a goal was missed
	@missed=; \
	for part in $(BENCHES); do \
	  echo "=== $$part"; \
	  OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/bench_$$part.py || missed="$$missed $$part"; \
	done; \
	echo "=== tasks"; \
	$(BIN)/lumitip bench-tasks --trials 100 --out $(OUT)/bench-tasks || missed="$$missed tasks"; \
	test -z "$$missed" || { echo "goals missed in:$$missed"; exit 1; }

pictures: outputs $(DOCS) ## draw the pictures of README and docs from OUT
	$(BIN)/lumitip-fab build design/presets/integrated.toml --out $(OUT)/integrated --quiet
	$(BIN)/lumitip-fab build design/presets/flex.toml --out $(OUT)/flex --quiet
	$(BIN)/python docs/pictures.py $(OUT) $(OUT)/integrated $(OUT)/flex
	$(BIN)/python docs/cable_animation.py
	$(BIN)/python docs/view_picture.py
	$(BIN)/python docs/contacts.py
	$(BIN)/python docs/twin_figures.py

site: $(SITE) ## build the documentation site into site/; a broken link is an error
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict --quiet
	@echo "open site/index.html"

schema: $(FAB) ## write design/schema.json anew
	$(BIN)/lumitip-fab schema > design/schema.json

golden: $(DEV) ## write the tests' reference files anew; read the diff before committing
	LUMITIP_GOLDEN=1 $(BIN)/python -m pytest -q -m golden

dist: $(DEV) ## build wheel and sdist into dist, the same bytes each time
	$(BIN)/python -m release.dist dist

lock: $(DEV) ## write the lock files anew: constraints.txt with the hashes of all files
	$(BIN)/python -m release.lock

bills: outputs $(DEV) ## write CycloneDX bills of software, and of the hardware in OUT, into dist
	$(BIN)/python -m release.bills $(OUT) dist

clean: ## remove what was generated, and .venv
	rm -rf .venv .mypy_cache .pytest_cache .ruff_cache site dist
	find outputs -mindepth 1 ! -name README.md -delete
