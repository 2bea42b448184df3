# make web, site and check-web; included by the Makefile.

# Debian's Emscripten needs the path of its loader's modules.
EM          := env NODE_PATH=/usr/share/nodejs
# emcc takes longer to start than most files take to compile, so the compiler behind it is called directly.
EM_CC        = $(shell $(EM) emcc -v -c engine/base/alloc.c -I. -o /dev/null 2>&1 | sed -n 's/^ "\([^"]*\)" -target.*/\1/p') $(shell $(EM) emcc --cflags)
WEB_OBJECTS := build-web
WEB_MAKE     = PKG_CONFIG_LIBDIR=$(CURDIR)/$(WEB_OBJECTS)/libraries/lib/pkgconfig $(MAKE) --no-print-directory BUILD=$(WEB_OBJECTS) \
                 PORTABLE=1 FLOAT= CC="$(EM_CC)" AR="$(EM) emar" CFLAGS=-O2 CPPFLAGS=-msimd128 KERNEL_CFLAGS="-O3 -fno-slp-vectorize"
# Memory grows up to the browser's limit for a page. The stack is large enough for a pool thread and for Lua.
WEB_LINK    := -O2 -msimd128 --no-entry -sMODULARIZE=1 -sEXPORT_NAME=createGlint -sENVIRONMENT=worker -sALLOW_MEMORY_GROWTH=1 \
                 -sMAXIMUM_MEMORY=2GB -sINITIAL_MEMORY=32MB -sTOTAL_STACK=2MB -sFORCE_FILESYSTEM=1 \
                 -sEXPORTED_FUNCTIONS=_malloc,_free -sEXPORTED_RUNTIME_METHODS=FS,UTF8ToString,stringToUTF8,lengthBytesUTF8

.PHONY: web web-module web-files web-pages site check-web
web: web-module ## build/web: the module glint-render, live figures, playground and course, in four minutes of processor time; installs what it needs through apt and npm
	+@$(MAKE) --no-print-directory web-pages

web-module:
	@tests/deps.sh build web
	@tests/machines/libraries.sh $(WEB_OBJECTS)/libraries "$(EM_CC)" "$(EM) emar" freetype
	+@$(WEB_MAKE) WEB=$(BUILD)/web web-files

WEB ?= $(BUILD)/web
web-files: $(WEB)/glint.wasm $(BUILD)/worker.mjs

ifneq ($(WASM),)
$(BUILD)/glint.js: $(BINDINGS_OBJ) $(BUILD)/libglint.a
	$(call say,LINK)
	$(Q)$(EM) emcc $(WEB_LINK) $(BINDINGS_OBJ) $(BUILD)/libglint.a $(LUA_LIBS) $(LIBS) -o $@

$(WEB)/glint.wasm: $(BUILD)/glint.js
	@mkdir -p $(@D)
	@cp $(BUILD)/glint.wasm $@

# The loader from emscripten and the worker around it become one file.
$(BUILD)/worker.mjs: $(BUILD)/glint.js bindings/web/worker.mjs
	@cat $^ > $@
endif

# The pages. npm brings the editor, the bundler and the test tools, in the versions of package-lock.json.
NPM         := $(BUILD)/npm
PAGES_SRC   := $(wildcard bindings/web/pages/*.js bindings/web/pages/*.mjs)
COURSE      := $(wildcard scripts/course/*.lua)
WEB_PAGES   := $(addprefix $(WEB)/,glint.mjs worker.mjs package.json LICENSE glint-figure.js glint-disk.js playground.js editor.js publish.js glint.wasm.gz glint.ttf glint.ttf.gz site.css index.html \
                  figure.html course.html \
                  examples/index.json examples/moving_light.png $(patsubst scripts/%,%,$(COURSE) $(COURSE:.lua=.png)))

web-pages: $(WEB_PAGES)

$(NPM)/node_modules: $(addprefix bindings/web/pages/,package.json package-lock.json .npmrc)
	@mkdir -p $(NPM)
	@cp $^ $(NPM)
	$(call say,NPM)
	$(Q)cd $(NPM) && npm ci --silent
	@touch $@

# esbuild finds packages next to the sources.
$(NPM)/sources: $(PAGES_SRC) bindings/web/glint.mjs $(WEB_OBJECTS)/worker.mjs engine/figures/text/symbols.c | $(NPM)/node_modules
	@cp $(filter-out %.c,$^) $(NPM)
	@node bindings/web/pages/symbols.mjs engine/figures/text/symbols.c >$(NPM)/symbols.json
	@touch $@

$(NPM)/worker.txt: $(WEB)/worker.mjs
	@cp $< $@

$(addprefix $(NPM)/,glint.wasm.gz glint.ttf.gz): $(NPM)/%: $(WEB)/%
	@cp $< $@

$(WEB)/glint.mjs: BUNDLE := --bundle --external:node:*
$(WEB)/worker.mjs: BUNDLE :=
$(addprefix $(WEB)/,glint-figure.js playground.js editor.js): BUNDLE := --bundle --external:./glint.mjs --external:./editor.js
$(WEB)/publish.js: BUNDLE := --bundle --external:node:* --loader:.txt=text
$(addprefix $(WEB)/,publish.js glint-disk.js): $(NPM)/worker.txt
$(WEB)/glint-disk.js: BUNDLE := --bundle --external:node:* --loader:.txt=text --loader:.gz=base64 --format=iife --log-override:empty-import-meta=silent
$(WEB)/glint-disk.js: $(NPM)/glint.wasm.gz $(NPM)/glint.ttf.gz
$(addprefix $(WEB)/,glint.mjs worker.mjs glint-figure.js playground.js editor.js publish.js glint-disk.js): $(WEB)/%: $(NPM)/sources
	$(call say,BUNDLE)
	$(Q)cd $(NPM) && node_modules/.bin/esbuild $* --format=esm $(BUNDLE) --minify --log-level=warning --outfile=$(CURDIR)/$@

$(WEB)/package.json: bindings/web/package.json engine/glint.h
	@sed -e 's/@version@/$(VERSION)/' $< > $@

$(WEB)/LICENSE: LICENSE
	@cat $< /usr/share/doc/fonts-dejavu-core/copyright > $@

$(WEB)/%.gz: $(WEB)/%
	@gzip -9 -n <$< >$@

# The font of labels: the letters of European languages, and the signs that engine/figures/text names.
FONT_CODES  := U+20-7E,U+A0-17F,U+300-36F,U+370-3FF,U+2010-2044,U+2070-209F,U+2100-2138,U+2190-22FF,U+25A0-25FF
$(WEB)/glint.ttf: /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf $(wildcard engine/figures/text/*.c)
	@mkdir -p $(@D)
	$(call say,FONT)
	$(Q)/usr/bin/python3 -m fontTools.subset $< --output-file=$@ --no-hinting --legacy-kern --layout-features= --name-IDs=* --drop-tables+=FFTM \
	    --unicodes="$(FONT_CODES) $$(cat engine/figures/text/*.c | grep -o 'U+[0-9A-F]\{4,5\}' | sort -u | tr '\n' ' ')"

$(addprefix $(WEB)/,site.css index.html): $(WEB)/%: bindings/web/pages/%
	@mkdir -p $(@D)
	@cp $< $@

# The module reads parameters and renders still pictures, so that the pages need no command.
MODULE      := $(addprefix $(WEB)/,glint.mjs worker.mjs glint.wasm glint.ttf)
# Pages of figures get the scripts of their figures, so that they work from a disk, too.
$(addprefix $(WEB)/,figure.html course.html): $(WEB)/%: bindings/web/pages/% bindings/web/pages/inline.mjs $(MODULE) $(COURSE) scripts/moving_light.lua
	@mkdir -p $(@D)
	$(Q)node bindings/web/pages/inline.mjs $< scripts $(WEB) >$@

$(WEB)/examples/index.json: $(WEB)/glint.mjs $(WEB)/worker.mjs $(WEB)/glint.wasm bindings/web/pages/examples.mjs $(wildcard scripts/*.lua)
	$(Q)mkdir -p $(@D) && node bindings/web/pages/examples.mjs $(WEB) scripts

PICTURE     := $(MODULE) bindings/web/pages/picture.mjs
$(WEB)/examples/moving_light.png: scripts/moving_light.lua $(PICTURE)
	@mkdir -p $(@D)
	$(Q)node bindings/web/pages/picture.mjs $(WEB) $< $@ 640 360

$(WEB)/course/%.lua: scripts/course/%.lua
	@mkdir -p $(@D)
	@cp $< $@

$(WEB)/course/%.png: scripts/course/%.lua $(PICTURE)
	@mkdir -p $(@D)
	$(Q)node bindings/web/pages/picture.mjs $(WEB) $< $@

check-web: web ## the module in node (bits, errors, limits, memory), the pages in headless Chromium, which it installs through apt
	@tests/deps.sh build test films
	@$(MAKE) --no-print-directory all
	@TEST_LIMIT_S=900 $(RUNNER) tests/web/module.sh tests/web/pages.sh tests/web/element.sh

site: web $(BUILD)/meta/glint.lua ## build/site: the pages of make web with the manual, the gallery and the reference, for any static host
	@rm -rf $(BUILD)/site
	$(Q)node $(NPM)/site.mjs $(CURDIR) $(WEB) $(BUILD)/site
	@cp bindings/web/pages/search.js $(BUILD)/site
