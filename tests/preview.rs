//! `tyndall-preview` as a process, without a window: its shaders against `tyndall sample`, its pictures, its errors.
//! Without a Vulkan driver these tests are skipped with a notice, unless TYNDALL_GPU_TESTS=required.

mod preview {
    mod answers;
    mod bench;
    #[cfg(target_os = "linux")]
    mod drop;
    mod golden;
    mod isolation;
    mod pictures;
    mod refused;
    mod run;
    mod seams;
    mod told;
    mod water;
    #[cfg(target_os = "linux")]
    mod window;
    mod windows;
}
