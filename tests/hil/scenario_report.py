"""Results of tests/hil/run as JUnit XML and as one HTML page."""
import html
import xml.etree.ElementTree as xml

COLOURS = {"stop": "#c0392b", "ramp": "#e67e22", "follow": "#27ae60"}
WIDTH = 480


def write_junit(results, file):
    suites = xml.Element("testsuites")
    for group in sorted({result["group"] for result in results}):
        of_group = [result for result in results if result["group"] == group]
        suite = xml.SubElement(
            suites, "testsuite", name=f"hil.{group}", tests=str(len(of_group)),
            failures=str(sum(bool(result["wrong"]) for result in of_group)),
            time=f"{sum(result['wall_s'] for result in of_group):.1f}")
        for result in of_group:
            case = xml.SubElement(suite, "testcase", classname=f"hil.{group}",
                                  name=result["name"], time=f"{result['wall_s']:.1f}")
            if result["wrong"]:
                xml.SubElement(case, "failure", message=result["wrong"][0]).text = \
                    "\n".join(result["wrong"])
            xml.SubElement(case, "system-out").text = "\n".join(
                f"cycle {round(at / result['cycle_ms'])}: {what}" for at, what in result["found"])
    xml.indent(suites)
    xml.ElementTree(suites).write(file, encoding="utf-8", xml_declaration=True)


def bar(result):
    """The controller's action over time; a tick for each fault."""
    scale = WIDTH / result["ends"]
    ends = [at for at, _ in result["found"][1:]] + [result["ends"]]
    parts = [f'<rect x="{at * scale:.1f}" width="{max(end - at, 0) * scale:.1f}" height="16" '
             f'fill="{COLOURS[what]}"/>' for (at, what), end in zip(result["found"], ends)]
    parts += [f'<path d="M{int(line.split()[0]) * scale:.1f} 0v22" stroke="black"/>'
              for line in result["faults"]]
    return f'<svg width="{WIDTH}" height="22">{"".join(parts)}</svg>'


def row(result):
    def cell(lines):
        return "<td>" + "<br>".join(html.escape(line) for line in lines) + "</td>"

    found = [f"{what} {at:.0f} ms, cycle {round(at / result['cycle_ms'])}"
             for at, what in result["found"][1:]]
    verdict = result["wrong"] or ["passed"]
    return (f'<tr class="{"wrong" if result["wrong"] else "ok"}">'
            + cell([result["name"], result["text"]]) + cell(result["faults"])
            + cell(result["expected"]) + cell(found) + f"<td>{bar(result)}</td>" + cell(verdict)
            + f"<td>{result['wall_s']:.1f} s</td></tr>")


def write_html(results, file):
    failed = sum(bool(result["wrong"]) for result in results)
    file.write_text(f"""<!DOCTYPE html><html lang="en"><meta charset="utf-8">
<title>Glint: hardware in the loop</title>
<style>body {{font: 14px sans-serif}} td, th {{padding: 4px 8px; vertical-align: top; text-align: left}}
tr.wrong {{background: #fdd}} tr {{border-bottom: 1px solid #ccc}} table {{border-collapse: collapse}}</style>
<h1>Hardware in the loop, emulated board</h1>
<p>{len(results)} scenarios, {failed} failed. Actions of the controller: red stop, orange ramp, green
follow; black lines: commands. Times from the scenario's start.</p>
<table><tr><th>scenario<th>commands, ms<th>expected, ms<th>found<th>action over time<th>verdict<th>time</tr>
{chr(10).join(row(result) for result in results)}
</table></html>
""")
