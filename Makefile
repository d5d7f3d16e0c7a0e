# make demo: build, and do everything once: simulate, encode, judge, draw, time; pictures and tables in demo-out/
# make test: the tests, on Vulkan and on OpenGL ES 3.0
# make check-targets: whether all of it compiles for Windows and Macs, what draws for browsers, and what apps link for Android on 32 bits; the decoder on a Cortex-M4 and its tests on s390x, emulated
# make android: the libraries for Android, the decoder's tests on other machines by qemu, then an AAR and an APK, and what an app gets; needs the NDK, R8, Maven
# make android-test: tests of android-demo/ on this machine's Java; says what it needs
# make fuzz: fuzz targets of the decoder and of the shaders' twins, a minute each; needs cargo-fuzz and a C++ compiler
# Where there is no graphics card, the first two install Mesa's software drivers with apt-get.

.PHONY: demo test check-targets android android-test fuzz

subsurf = cargo run --quiet --release --package subsurf-cli --
study = cargo run --quiet --release --package subsurf-study --

demo:
	cargo build --release --package subsurf-cli --package subsurf-study
	@scripts/has-gpu "$(subsurf)" || scripts/has-drivers "$(subsurf)" || scripts/install-software-gpu \
		|| echo "going on with what there is; the CPU renderer needs no driver"
	$(subsurf) demo
	$(study) bench load --files demo-out/onyx.npy demo-out/onyx-profiles.subsurf demo-out/onyx.subsurf -o demo-out

test:
	scripts/test

check-targets:
	scripts/cortex-m
	scripts/emulated s390x
	scripts/check-targets

android:
	scripts/android
	scripts/emulated
	scripts/android-package

android-test:
	scripts/android-jvm

fuzz:
	scripts/fuzz
