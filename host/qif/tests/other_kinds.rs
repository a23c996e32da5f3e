//! What product models hold that a part does not: each is counted in the list, and none fails the import or is guessed.

use slipfit_qif::{model::read, part::write};

/// A model in inch with a countersunk hole, a thread, a pattern and a face on which a datum has targets.
fn model(definitions: &str, nominals: &str) -> String {
    format!(
        r#"<QIFDocument xmlns="http://qifstandards.org/xsd/qif3">
<FileUnits><PrimaryUnits>
  <LinearUnit><SIUnitName>meter</SIUnitName><UnitName>in</UnitName><UnitConversion><Factor>0.0254</Factor></UnitConversion></LinearUnit>
</PrimaryUnits></FileUnits>
<DatumDefinitions n="2">
  <DatumDefinition id="1"><DatumLabel>A</DatumLabel><FeatureNominalIds n="1"><Id>10</Id></FeatureNominalIds>
    <DatumTargetIds n="3"><Id>7</Id><Id>8</Id><Id>9</Id></DatumTargetIds></DatumDefinition>
  <DatumDefinition id="2"><DatumLabel>B</DatumLabel><FeatureNominalIds n="1"><Id>10</Id></FeatureNominalIds></DatumDefinition>
</DatumDefinitions>
<DatumReferenceFrames n="2">
  <DatumReferenceFrame id="3"><Datums n="1"><Datum><SimpleDatum><DatumDefinitionId>1</DatumDefinitionId></SimpleDatum>
    <Precedence><PrecedenceEnum>PRIMARY</PrecedenceEnum></Precedence></Datum></Datums></DatumReferenceFrame>
  <DatumReferenceFrame id="4"><Datums n="1"><Datum><SimpleDatum><DatumDefinitionId>2</DatumDefinitionId></SimpleDatum>
    <Precedence><PrecedenceEnum>PRIMARY</PrecedenceEnum></Precedence></Datum></Datums></DatumReferenceFrame>
</DatumReferenceFrames>
<Product><PartSet n="1"><Part id="5" label="bracket"/></PartSet></Product>
<Features>
  <FeatureDefinitions n="2">
    <CylinderFeatureDefinition id="20"><InternalExternal>INTERNAL</InternalExternal><Diameter>0.5</Diameter><Length>1</Length></CylinderFeatureDefinition>
    <ConeFeatureDefinition id="21"><Diameter>0.7</Diameter></ConeFeatureDefinition>
  </FeatureDefinitions>
  <FeatureNominals n="5">
    <PlaneFeatureNominal id="10"><Name>base</Name><Location>0 0 0</Location><Normal>0 0 1</Normal></PlaneFeatureNominal>
    <CylinderFeatureNominal id="11"><FeatureDefinitionId>20</FeatureDefinitionId><Name>bore</Name>
      <Axis><AxisPoint>1 0 0</AxisPoint><Direction>0 0 1</Direction></Axis></CylinderFeatureNominal>
    <ConeFeatureNominal id="12"><FeatureDefinitionId>21</FeatureDefinitionId><Name>countersink</Name></ConeFeatureNominal>
    <ThreadedFeatureNominal id="13"><Name>thread</Name></ThreadedFeatureNominal>
    <CylinderFeatureNominal id="14"><FeatureDefinitionId>20</FeatureDefinitionId><Name>without an axis</Name></CylinderFeatureNominal>
  </FeatureNominals>
</Features>
<Characteristics>
  <CharacteristicDefinitions n="1">{definitions}</CharacteristicDefinitions>
  <CharacteristicNominals n="1">{nominals}</CharacteristicNominals>
</Characteristics>
</QIFDocument>"#
    )
}

/// A characteristic of a kind with these elements, of a feature.
fn characteristic(id: usize, kind: &str, elements: &str, feature: usize) -> [String; 2] {
    [
        format!("<{kind}CharacteristicDefinition id=\"{id}\">{elements}</{kind}CharacteristicDefinition>"),
        format!(
            "<{kind}CharacteristicNominal id=\"1{id}\"><CharacteristicDefinitionId>{id}</CharacteristicDefinitionId>\
             <FeatureNominalIds n=\"1\"><Id>{feature}</Id></FeatureNominalIds></{kind}CharacteristicNominal>"
        ),
    ]
}

#[test]
fn other_kinds_are_listed_and_nothing_is_guessed() {
    let zone = "<ToleranceValue>0.01</ToleranceValue>";
    let at_b = "<DatumReferenceFrameId>4</DatumReferenceFrameId>";
    let diameter = "<ZoneShape><DiametricalZone/></ZoneShape>";
    let limits = "<Tolerance><MaxValue>0.01</MaxValue><MinValue>-0.01</MinValue><DefinedAsLimit>false</DefinedAsLimit></Tolerance>";
    let lower = format!(
        "<SecondCompositeSegmentPositionDefinition>{zone}{diameter}</SecondCompositeSegmentPositionDefinition>"
    );
    let third =
        format!("<ThirdCompositeSegmentPositionDefinition>{zone}{diameter}</ThirdCompositeSegmentPositionDefinition>");
    let cases: Vec<(&str, String, usize)> = vec![
        ("Position", format!("{zone}<DatumReferenceFrameId>3</DatumReferenceFrameId>{diameter}"), 11),
        ("Position", format!("{zone}{diameter}{at_b}{lower}"), 11),
        ("Position", format!("{zone}{diameter}{at_b}{lower}{third}"), 11),
        ("SurfaceProfile", format!("{zone}{at_b}<OuterDisposition>0.008</OuterDisposition>"), 10),
        ("LineProfile", format!("{zone}{at_b}"), 10),
        ("Thread", "<ThreadSpecification>M8</ThreadSpecification>".into(), 13),
        ("ConeAngle", "<Tolerance><MaxValue>1</MaxValue><MinValue>-1</MinValue></Tolerance>".into(), 12),
        ("Diameter", limits.into(), 12),
        ("Diameter", limits.into(), 14),
        ("Depth", limits.into(), 11),
        ("Flatness", format!("{zone}<PerUnitArea>1</PerUnitArea>"), 10),
        ("Position", format!("{zone}{diameter}<ProjectedToleranceZone>0.5</ProjectedToleranceZone>"), 11),
        ("SurfaceTexture", String::new(), 10),
    ];
    let all: Vec<_> = cases
        .iter()
        .enumerate()
        .map(|(i, (kind, elements, of))| characteristic(100 + i, kind, elements, *of))
        .collect();
    let text = model(
        &all.iter().map(|[a, _]| a.as_str()).collect::<String>(),
        &all.iter().map(|[_, b]| b.as_str()).collect::<String>(),
    );
    let drawing = read(&text).expect("a drawing");
    let part = write(&drawing, None, "a file");
    assert_eq!((drawing.features.len(), drawing.tolerances.len()), (5, cases.len()));
    assert!(part.left_out.contains(&format!("#| {0} of {0} tolerances", cases.len())), "{}", part.left_out);
    for (i, (kind, ..)) in cases.iter().enumerate() {
        assert!(part.left_out.contains(&format!("[1{}]", 100 + i)), "{kind}: {}", part.left_out);
    }
    for feature in ["countersink", "thread", "without an axis"] {
        assert!(part.left_out.contains(feature), "{}", part.left_out);
    }
    toml::from_str::<toml::Table>(&part.file()).expect("valid TOML");
}

#[test]
fn inches_are_converted_where_all_is_understood() {
    let limits = "<Tolerance><MaxValue>0.01</MaxValue><MinValue>-0.01</MinValue><DefinedAsLimit>false</DefinedAsLimit></Tolerance>";
    let [definition, nominal] = characteristic(100, "Diameter", limits, 11);
    let part = write(&read(&model(&definition, &nominal)).expect("a drawing"), None, "a file");
    assert!(part.text.contains("diameter = { value = 12.7, tolerance = [-0.254, 0.254] }"), "{}", part.text);
    assert!(part.text.contains("length = 25.4"), "{}", part.text);
}
