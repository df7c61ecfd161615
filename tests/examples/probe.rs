//! probe
use std::io::Write;
fn main() {
    let f: Vec<String> = std::env::args().skip(1).collect();
    for c in carom_tests::catalogue::all() {
        if !f.is_empty() && !f.iter().any(|x| c.id == x) { continue; }
        print!("{} {} ...", c.id, c.title);
        std::io::stdout().flush().unwrap();
        let t = std::time::Instant::now();
        let r = std::panic::catch_unwind(|| (c.run)());
        match r { Ok(r) => println!("\n    [{}] {} ({:.2} s)", if r.holds {"ok"} else {"BROKEN"}, r.text, t.elapsed().as_secs_f64()),
          Err(_) => println!("\n   PANIC") }
    }
}
