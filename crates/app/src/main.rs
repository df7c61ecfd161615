//! The program `carom`.

fn main() -> std::process::ExitCode {
    carom::main()
}
