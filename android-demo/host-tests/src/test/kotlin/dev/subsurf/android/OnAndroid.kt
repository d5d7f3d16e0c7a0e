package dev.subsurf.android

/** Category of tests that run against the classes of the framework, in a virtual machine of their own. */
interface OnAndroid
