# make demo: build, and do everything once: simulate, encode, judge, draw, time; pictures and tables in demo-out/
# make test: every test, on Vulkan and on OpenGL ES 3.0
# Both install Mesa's software drivers with apt-get if no device is found.

.PHONY: demo test

subsurf = cargo run --quiet --release --package subsurf-cli --

demo:
	cargo build --release --package subsurf-cli
	@$(subsurf) devices --quiet 2>/dev/null || scripts/install-software-gpu || echo "going on with the CPU renderer"
	$(subsurf) demo

# The tests need both backends, and Mesa for OpenGL ES 3.0 in particular.
test:
	cargo build --package subsurf-cli
	@scripts/has-test-drivers || scripts/install-software-gpu
	cargo test --workspace
	decoder/freestanding/check
